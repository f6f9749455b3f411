#include <gridmorph/page/surface_picture.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

namespace gridmorph::page {

namespace {

Vec3 unit_vector(Vec3 const& v) {
  double const length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3{0, 0, 1};
}

/// Twice the area, as a vector along the normal.
Vec3 area_of(Facet const& f, std::vector<Vec3> const& at) {
  auto const p = [&](std::size_t n) { return at[f.node[n]]; };
  return f.size() == 3 ? cross(p(1) - p(0), p(2) - p(0)) : cross(p(2) - p(0), p(3) - p(1));
}

View looking(Vec3 const& towards, Vec3 const& up) {
  View view;
  view.towards = unit_vector(towards);
  Vec3 const across = cross(up, view.towards);
  view.right = norm(across) > 1e-6 ? unit_vector(across) : unit_vector(cross({1, 0, 0}, view.towards));
  view.up = cross(view.towards, view.right);
  return view;
}

/// Centre and scale: what is in focus, before and after, fills four fifths of the picture.
void frame(View& view, Surface const& surface, std::vector<Vec3> const& displacement, int width, int height) {
  bool const any = std::any_of(surface.focus.begin(), surface.focus.end(), [](char f) { return f != 0; });
  constexpr double large = std::numeric_limits<double>::max();
  double low[2] = {large, large}, high[2] = {-large, -large};
  for (std::size_t n = 0; n < surface.nodes.size(); ++n) {
    if (any && surface.focus[n] == 0) continue;
    for (Vec3 const& p : {surface.baseline[n], surface.baseline[n] + displacement[n]}) {
      double const at[2] = {dot(p, view.right), dot(p, view.up)};
      for (int d = 0; d < 2; ++d) {
        low[d] = std::min(low[d], at[d]);
        high[d] = std::max(high[d], at[d]);
      }
    }
  }
  if (low[0] > high[0]) return;
  double const x = std::max(high[0] - low[0], 1e-12 * std::fabs(high[0])), y = std::max(high[1] - low[1], 1e-3 * x);
  view.pixels = 0.8 * std::min(width / x, height / y);
  view.centre = 0.5 * (low[0] + high[0]) * view.right + 0.5 * (low[1] + high[1]) * view.up;
}

/// Opacity of mesh lines between nodes so many pixels apart: none where they would run into one another.
double line_opacity(double pixels) { return 0.45 * std::clamp((pixels - 3) / 6, 0.0, 1.0); }

}  // namespace

namespace {

/// Gives nodes of the mesh their places in a surface.
class SurfaceNumbers {
 public:
  SurfaceNumbers(Surface& surface, Coordinates const& baseline) : surface_(surface), baseline_(baseline) {}
  Index32 operator()(Index32 node) {
    auto const [at, added] = number_.emplace(node, Index32(surface_.nodes.size()));
    if (added) {
      surface_.nodes.push_back(node);
      surface_.baseline.push_back(baseline_[node]);
      surface_.focus.push_back(0);
    }
    return at->second;
  }

 private:
  Surface& surface_;
  Coordinates const& baseline_;
  std::unordered_map<Index32, Index32> number_;
};

/// Edges that one facet of moving patches has alone. Zones have nodes of their own where they meet: nodes at one place
/// count as one.
std::vector<Edge> rims_of(Surface const& surface, std::vector<signed char> const& role) {
  double size = 0;
  for (Vec3 const& p : surface.baseline) size = std::max(size, norm(p - surface.baseline.front()));
  double const step = size > 0 ? 1e-7 * size : 1;
  using Cell = std::array<std::int64_t, 3>;
  std::map<Cell, Index32> places;  // in order, so that pictures are the same in every run
  std::vector<Index32> place(surface.nodes.size(), -1);
  auto const place_of = [&](Index32 n) {
    if (place[n] < 0) {
      Vec3 const d = (1 / step) * (surface.baseline[n] - surface.baseline.front());
      place[n] = places.emplace(Cell{std::llround(d.x), std::llround(d.y), std::llround(d.z)}, n).first->second;
    }
    return place[n];
  };
  std::map<std::array<Index32, 2>, int> times;
  for (Facet const& facet : surface.facets) {
    if (role[facet.patch] < 1) continue;
    for (std::size_t c = 0; c < facet.size(); ++c) {
      Index32 const a = place_of(facet.node[c]), b = place_of(facet.node[(c + 1) % facet.size()]);
      if (a != b) ++times[{std::min(a, b), std::max(a, b)}];
    }
  }
  std::vector<Edge> out;
  for (auto const& [edge, n] : times)
    if (n == 1) out.push_back({edge, 0});
  return out;
}

}  // namespace

Surface make_surface(std::vector<Facet> const& facets, std::vector<signed char> const& role,
                     Coordinates const& baseline) {
  Surface out;
  SurfaceNumbers number(out, baseline);
  for (Facet facet : facets) {
    if (facet.patch < 0 || role[facet.patch] < 0) continue;
    for (std::size_t c = 0; c < facet.size(); ++c) {
      facet.node[c] = number(facet.node[c]);
      if (role[facet.patch] > 0) out.focus[facet.node[c]] = 1;
    }
    out.facets.push_back(facet);
  }
  out.rims = rims_of(out, role);
  return out;
}

Surface make_surface(PictureMesh::Plane const& plane, std::vector<signed char> const& role,
                     Coordinates const& baseline) {
  Surface out;
  SurfaceNumbers number(out, baseline);
  for (Facet facet : plane.facets) {
    for (std::size_t c = 0; c < facet.size(); ++c) facet.node[c] = number(facet.node[c]);
    out.facets.push_back(facet);
  }
  for (Edge side : plane.sides) {
    if (side.patch < 0 || role[side.patch] < 0) continue;
    for (Index32& n : side.node) {
      n = number(n);
      if (role[side.patch] > 0) out.focus[n] = 1;
    }
    out.rims.push_back(side);
  }
  return out;
}

View plane_view(Surface const& surface, std::vector<Vec3> const& displacement, int width, int height) {
  Vec3 normal;
  for (Facet const& f : surface.facets) normal += area_of(f, surface.baseline);
  normal = unit_vector(normal);
  Vec3 const size{std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)};
  // Seen along a coordinate, the other two to the right and up where they can be.
  View view;
  if (size.z >= size.x && size.z >= size.y)
    view = looking({0, 0, normal.z}, {0, 1, 0});
  else if (size.y >= size.x)
    view = looking({0, normal.y, 0}, {0, 0, 1});
  else
    view = looking({normal.x, 0, 0}, {0, 0, 1});
  frame(view, surface, displacement, width, height);
  return view;
}

std::array<View, 2> find_views(Surface const& surface, std::vector<Vec3> const& displacement, Vec3 const& up, int width,
                               int height) {
  // Obliquely, from above, in a frame about `up`.
  Vec3 const side = unit_vector(std::fabs(up.x) < 0.9 ? cross(up, {1, 0, 0}) : cross(up, {0, 1, 0}));
  Vec3 const front = cross(side, up);
  std::vector<Vec3> directions;
  for (int n = 0; n < 8; ++n) {
    double const angle = (2 * n + 1) * 3.14159265358979323846 / 8;
    for (double const height_of : {0.35, -0.35, 0.9})
      directions.push_back(unit_vector(std::cos(angle) * side + std::sin(angle) * front + height_of * up));
  }
  std::vector<double> seen(directions.size(), 0);
  bool const still = std::all_of(displacement.begin(), displacement.end(), [](Vec3 const& u) { return norm(u) == 0; });
  for (Facet const& f : surface.facets) {
    Vec3 const area = area_of(f, surface.baseline);
    double moved = still ? 1 : 0;
    for (std::size_t c = 0; c < f.size(); ++c) moved = std::max(moved, norm(displacement[f.node[c]]));
    for (std::size_t d = 0; d < directions.size(); ++d) seen[d] += moved * std::max(0.0, dot(area, directions[d]));
  }
  auto const better = [&](std::size_t a, std::size_t b) { return seen[a] > seen[b] * (1 + 1e-9); };
  std::size_t best = 0, other = 0;
  double score = -1;
  for (std::size_t d = 1; d < directions.size(); ++d)
    if (better(d, best)) best = d;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    Vec3 const a = directions[d] - dot(directions[d], up) * up, b = directions[best] - dot(directions[best], up) * up;
    double const now = dot(a, b) < -0.5 * norm(a) * norm(b) ? seen[d] : -1;
    if (now > score * (1 + 1e-9)) {
      score = now;
      other = d;
    }
  }
  std::array<View, 2> out{looking(directions[best], up), looking(directions[other], up)};
  for (View& view : out) frame(view, surface, displacement, width, height);
  return out;
}

io::Picture surface_picture(Surface const& surface, std::vector<Vec3> const& displacement, double most,
                            View const& view, int width, int height) {
  Canvas canvas(width, height);
  auto const project = [&](Vec3 const& p) -> Place {
    Vec3 const d = p - view.centre;
    return {0.5 * width + view.pixels * dot(d, view.right), 0.5 * height - view.pixels * dot(d, view.up),
            view.pixels * dot(d, view.towards)};
  };
  std::vector<Vec3> moved(surface.nodes.size());
  std::vector<Place> at(surface.nodes.size());
  std::vector<double> share(surface.nodes.size());
  for (std::size_t n = 0; n < at.size(); ++n) {
    moved[n] = surface.baseline[n] + displacement[n];
    at[n] = project(moved[n]);
    share[n] = most > 0 ? norm(displacement[n]) / most : 0;
  }
  Vec3 const lamp = unit_vector(0.35 * view.right + 0.5 * view.up + view.towards);
  std::vector<Facet const*> front;
  for (Facet const& f : surface.facets) {
    Vec3 const normal = unit_vector(area_of(f, moved));
    if (!(dot(normal, view.towards) > 0)) continue;
    front.push_back(&f);
    double const light = 0.68 + 0.36 * std::max(0.0, dot(normal, lamp));
    for (std::size_t c = 2; c < f.size(); ++c) {
      auto const a = std::size_t(f.node[0]), b = std::size_t(f.node[c - 1]), d = std::size_t(f.node[c]);
      canvas.triangle({at[a], at[b], at[d]}, {share[a], share[b], share[d]}, displacement_colours(), light);
    }
  }
  // Half a pixel towards the viewer, or lines would sink into the facets that they bound.
  auto const raised = [](Place const& p) { return Place{p.x, p.y, p.z + 0.75}; };
  for (Facet const* f : front) {
    double shortest = std::numeric_limits<double>::max();
    auto const corner = [&](std::size_t c) { return at[f->node[c % f->size()]]; };
    for (std::size_t c = 0; c < f->size(); ++c) {
      Place const a = corner(c), b = corner(c + 1);
      double const pixels = std::hypot(a.x - b.x, a.y - b.y);
      if (pixels > 0.3) shortest = std::min(shortest, pixels);
    }
    double const opacity = line_opacity(shortest);
    if (opacity <= 0) continue;
    for (std::size_t c = 0; c < f->size(); ++c)
      canvas.line(raised(corner(c)), raised(corner(c + 1)), {0x18, 0x1c, 0x22, opacity}, 0.5, false);
  }
  for (Edge const& rim : surface.rims) {
    Place const a = project(surface.baseline[rim.node[0]]);
    Place const b = project(surface.baseline[rim.node[1]]);
    canvas.line(raised(a), raised(b), {0x2b, 0x6c, 0xd4, 0.9}, 1.5);
  }
  return canvas.picture();
}

}  // namespace gridmorph::page
