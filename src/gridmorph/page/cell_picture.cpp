#include <gridmorph/geometry/symmetric_eigen.hpp>
#include <gridmorph/page/report_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace gridmorph::page {

namespace {

constexpr double side = 200;  ///< of a drawing, pixels

/// From space to the drawing, about a cell's middle.
struct CellView {
  Vec3 x, y;  ///< what a place is multiplied with; scaled
  double stretch = 1;
};

std::vector<Index32> nodes_of(CellFaces const& faces) {
  std::vector<Index32> out = faces.node;
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Vec3 middle_of(std::vector<Index32> const& nodes, Coordinates const& at) {
  Vec3 sum;
  for (Index32 const n : nodes) sum += at[n];
  return (1 / double(nodes.size())) * sum;
}

CellView view_of(std::vector<Index32> const& nodes, Coordinates const& baseline, Coordinates const& morphed,
                 bool plane) {
  Vec3 const middle = middle_of(nodes, baseline);
  SmallMatrix<3> spread{};
  for (Index32 const n : nodes) {
    Vec3 const d = baseline[n] - middle;
    std::array<double, 3> const v{d.x, d.y, d.z};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) spread[a][b] += v[a] * v[b];
  }
  auto const principal = symmetric_eigen(spread);
  std::array<double, 3> size{}, scale{};
  constexpr double most = 3;  // longest against shortest direction, as drawn
  for (std::size_t a = 0; a < 3; ++a) size[a] = std::sqrt(std::max(0.0, principal.value[a]));
  for (std::size_t a = 0; a < 3; ++a) scale[a] = size[a] > 0 ? std::max(1.0, size[0] / (most * size[a])) : 1;
  // Obliquely onto the two longest directions; straight onto a plane.
  std::array<std::array<double, 3>, 2> const oblique{{{0.88, -0.40, 0.26}, {0.22, 0.80, 0.55}}};
  std::array<std::array<double, 3>, 2> const straight{{{1, 0, 0}, {0, 1, 0}}};
  auto const& from = plane ? straight : oblique;
  CellView view{{}, {}, plane ? scale[1] : std::max(scale[1], scale[2])};
  for (std::size_t a = 0; a < 3; ++a) {
    Vec3 const axis{principal.vector[a][0], principal.vector[a][1], principal.vector[a][2]};
    view.x += (from[0][a] * scale[a]) * axis;
    view.y += (from[1][a] * scale[a]) * axis;
  }
  double reach = 0;
  for (Coordinates const* at : {&baseline, &morphed}) {
    Vec3 const m = middle_of(nodes, *at);
    for (Index32 const n : nodes) {
      Vec3 const d = (*at)[n] - m;
      reach = std::max({reach, std::fabs(dot(d, view.x)), std::fabs(dot(d, view.y))});
    }
  }
  double const pixels = reach > 0 ? 0.28 * side / reach : 1;
  view.x = pixels * view.x;
  view.y = pixels * view.y;
  return view;
}

using Edges = std::set<std::pair<Index32, Index32>>;

void add_edges(CellFaces const& faces, Edges& out) {
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t c = 0; c < faces[f].size(); ++c) {
      Index32 const a = faces[f][c], b = faces[f][(c + 1) % faces[f].size()];
      if (a != b) out.emplace(std::min(a, b), std::max(a, b));
    }
}

std::string path_of(Edges const& edges, auto const& place) {
  std::string path;
  for (auto const& [a, b] : edges) {
    auto const p = place(a), q = place(b);
    path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", p[0], p[1], q[0], q[1]);
  }
  return path;
}

std::string drawing(CellFaces const& faces, Edges const& own, Edges const& beside, std::vector<Index32> const& nodes,
                    Coordinates const& at, CellView const& view) {
  Vec3 const middle = middle_of(nodes, at);
  auto const place = [&](Index32 n) {
    Vec3 const d = at[n] - middle;
    // A neighbour may be a thousand times as large: what is far outside is as good at the rim.
    auto const near_by = [](double v) { return std::clamp(v, -20 * side, 20 * side); };
    return std::array{near_by(0.5 * side + dot(d, view.x)), near_by(0.5 * side - dot(d, view.y))};
  };
  std::string text = fmt::format(
      "<svg class=\"cell\" viewBox=\"0 0 {0:.0f} {0:.0f}\" width=\"{0:.0f}\" height=\"{0:.0f}\" role=\"img\">", side);
  text += "<path class=\"beside\" d=\"" + path_of(beside, place) + "\"/><g class=\"faces\">";
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].size() < 3) continue;
    text += "<path d=\"";
    for (std::size_t c = 0; c < faces[f].size(); ++c) {
      auto const p = place(faces[f][c]);
      text += fmt::format("{}{:.1f} {:.1f}", c == 0 ? "M" : "L", p[0], p[1]);
    }
    text += "Z\"/>";
  }
  return text + "</g><path class=\"edges\" d=\"" + path_of(own, place) + "\"/></svg>";
}

}  // namespace

CellDrawing draw_cell(PictureMesh const& mesh, Index cell, Coordinates const& baseline, Coordinates const& morphed) {
  CellFaces faces, other;
  mesh.faces(cell, faces);
  Edges own, beside;
  add_edges(faces, own);
  constexpr std::size_t most_cells = 120;
  auto const around = mesh.around(cell);
  for (std::size_t n = 0; n < around.size() && n < most_cells; ++n) {
    mesh.faces(around[n], other);
    add_edges(other, beside);
  }
  for (auto const& edge : own) beside.erase(edge);
  auto const nodes = nodes_of(faces);
  CellView const view = view_of(nodes, baseline, morphed, mesh.mesh().dimension == 2 && !mesh.mesh().is_structured());
  return {drawing(faces, own, beside, nodes, baseline, view), drawing(faces, own, beside, nodes, morphed, view),
          view.stretch};
}

}  // namespace gridmorph::page
