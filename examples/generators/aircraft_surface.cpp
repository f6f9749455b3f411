#include <generators/aircraft_shape.hpp>
#include <generators/aircraft_surface.hpp>
#include <generators/spacing.hpp>

#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_map>

namespace gridmorph::aircraft {

namespace {

constexpr double quarter = std::numbers::pi / 2, degree = quarter / 90;

/// Of the face of a cube seen from its centre: from -1 to 1 for shares from -1 to 1, even in the angle.
double on_cube(double share) { return std::tan(quarter / 2 * share); }

struct OnFuselage {
  double q, angle;
};

/// Puts the nodes of one body after the other; nodes that bodies share belong to the one put first.
class Placer {
 public:
  explicit Placer(Lattice const& lattice) : lattice_(lattice) {}

  void place(WallFace const& face) {
    if (face.part == Part::fuselage) return place_fuselage(face);
    for_nodes(face.nodes, [&](Index3 const& p) {
      if (at_.contains(lattice_.number(p))) return;
      switch (face.part) {
        case Part::wing: put(p, lifting(shape_.wing, face, p, {0, 2, 1}, j_side, j_tip_begin)); break;
        case Part::htail: put(p, lifting(shape_.htail, face, p, {0, 2, 1}, j_side, j_nacelle_in)); break;
        case Part::vtail: put(p, lifting(shape_.vtail, face, p, {0, 1, 2}, k_crown, k_crown)); break;
        default: put(p, nacelle(face, p));
      }
    });
  }
  [[nodiscard]] Vec3 at(Index lattice_node) const { return at_.at(lattice_node); }

  template <class F>
  static void for_nodes(IndexRange const& r, F const& f) {
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) f(Index3{i, j, k});
  }

 private:
  Lattice const& lattice_;
  Shape shape_;
  std::unordered_map<Index, Vec3> at_;
  std::unordered_map<Index, OnFuselage> on_fuselage_;  ///< of nodes that caps and other bodies place

  void put(Index3 const& p, Vec3 const& x) { at_.emplace(lattice_.number(p), x); }
  /// Share of the slab of a cell at a node of it.
  [[nodiscard]] double share(Index3 const& cell, int axis, int node) const {
    return node == lattice_.plane[axis][cell[axis] + 1] ? 1 : lattice_.share[axis][node];
  }
  /// Share of the cells of the slab.
  [[nodiscard]] double even_share(Index3 const& cell, int axis, int node) const {
    int const begin = lattice_.plane[axis][cell[axis]];
    return double(node - begin) / (lattice_.plane[axis][cell[axis] + 1] - begin);
  }

  /// axes: of the lattice along the chord, across and along the span; first and last slab along the span.
  Vec3 lifting(LiftingSurface const& surface, WallFace const& face, Index3 const& p, Index3 const& axes, int first,
               int last) {
    int const along = axes[0], across = axes[1], span = axes[2];
    bool const half = face.part == Part::vtail;  // beside the symmetry plane
    double const c = even_share(face.cell, across, p[across]);
    double const v = on_cube(half ? c : 2 * c - 1);
    // Along the span: up to the section of the tip, then around it.
    int const slab = face.cell[span], end = lattice_.plane[span][slab + 1];
    int const tip = end - tip_cells(end - lattice_.plane[span][slab]);
    double t = share(face.cell, span, p[span]), u = 0;
    if (slab == last) {
      double const begin = lattice_.share[span][tip];
      if (p[span] > tip) u = on_cube((t - begin) / (1 - begin));
      t = std::min(t / begin, 1.0);
    }
    auto const station = [&](int plane) {
      if (half || plane > last) return plane > first ? 1.0 : 0.0;
      double const root = surface.root.y, length = surface.tip.y - root;
      constexpr double y[] = {0, 0, 0, 4.4, 7.6, 11.8, 16};
      return plane == first ? 0 : (plane == last && last == j_nacelle_in ? 3.2 - root : y[plane] - root) / length;
    };
    auto const at = [&](double s) {
      if (face.axis == along && face.side == 0) return surface.at_nose(s, u, v);
      double const front = LiftingSurface::front(u, v), w = share(face.cell, along, p[along]);
      double x = front + (1 - front) * w;
      if (face.axis == along)
        x = 1;
      else if (face.part == Part::wing && face.cell[0] == i_leading)
        x = front + (Shape::hinge - front) * w;
      else if (face.part == Part::wing)
        x = Shape::hinge + (1 - Shape::hinge) * w;
      return surface.at(s, x, u, v);
    };
    if (slab != first) return at((1 - t) * station(slab) + t * station(slab + 1));
    // From the fuselage on, which the section meets where a fixed point says.
    double root = 0;
    for (int step = 0; step < 60; ++step) {
      Vec3 const x = at(root);
      double const to = half ? shape_.fuselage.top(x.x, x.y) : shape_.fuselage.side(x.x, x.z);
      root += half ? (to - x.z) / (surface.tip.z - surface.root.z) : (to - x.y) / (surface.tip.y - surface.root.y);
    }
    Vec3 const x = at((1 - t) * root + t * station(slab + 1));
    if (t == 0) {
      double const r = shape_.fuselage.radius_at(x.x), height = x.z - shape_.fuselage.centre_at(x.x);
      on_fuselage_.emplace(lattice_.number(p), OnFuselage{x.x, half ? std::acos(x.y / r) : std::asin(height / r)});
    }
    return x;
  }

  Vec3 nacelle(WallFace const& face, Index3 const& p) const {
    double d[3];
    for (int a = 0; a < 3; ++a)
      d[a] = a == face.axis ? 2 * face.side - 1 : on_cube(2 * even_share(face.cell, a, p[a]) - 1);
    return shape_.nacelle.at({d[0], d[1], d[2]});
  }

  // The fuselage, by stations and angles.

  static constexpr double belly = -62 * degree, crown = 55 * degree, cap = 0.6;

  /// The cap's edges are straight seen from the centre of the nose's, or the end's, circles.
  [[nodiscard]] OnFuselage on_cap(WallFace const& face, Index3 const& p) const {
    double const low = cap * std::tan(belly), high = cap * std::tan(crown);
    auto const& k = lattice_.plane[2];
    auto const angle = [&](int plane) { return default_angle(face.side == 0 ? i_nose : i_end, j_side, plane); };
    double const t = even_share(face.cell, 2, p[2]);
    double v = cap * ((1 - t) * std::tan(angle(face.cell[2])) + t * std::tan(angle(face.cell[2] + 1)));
    if (p[2] == k[k_belly]) v = low;
    if (p[2] == k[k_crown]) v = high;
    double const b = even_share(face.cell, 1, p[1]);
    double const u = face.cell[1] == 0 ? 0.3 * cap * b : cap * (0.3 + 0.7 * b);
    double const off = std::atan(std::hypot(u, v)), around = std::atan2(v, u);
    return {face.side == 0 ? shape_.fuselage.station_of_nose(off) : shape_.fuselage.station_of_end(off), around};
  }

  /// Of the planes that cross the fuselage, where nothing else says.
  [[nodiscard]] static double default_angle(int i, int j, int k) {
    bool const tail = i >= i_tail_leading;
    if (j < j_side) {
      double const at_plane = j == j_symmetry ? 90 * degree : (tail && k == k_crown ? 77 : 80) * degree;
      return k == k_belly ? -at_plane : at_plane;
    }
    double const front[] = {belly, -38 * degree, -10 * degree, 10 * degree, 32 * degree, crown};
    double const rear[] = {belly, -42 * degree, -25 * degree, -5 * degree, 20 * degree, crown};
    return tail ? rear[k - k_belly] : front[k - k_belly];
  }
  [[nodiscard]] double default_station(int i) const {
    constexpr double x[] = {0, 0, 5, 9, 12.7, 17.4, 19.1, 30.6, 35.1};
    return x[i];
  }
  [[nodiscard]] OnFuselage corner(Index3 const& planes) const {
    auto const fixed = on_fuselage_.find(
        lattice_.number({lattice_.plane[0][planes[0]], lattice_.plane[1][planes[1]], lattice_.plane[2][planes[2]]}));
    if (fixed != on_fuselage_.end()) return fixed->second;
    return {default_station(planes[0]), default_angle(planes[0], planes[1], planes[2])};
  }

  void place_fuselage(WallFace const& face) {
    auto const put_at = [&](Index3 const& p, OnFuselage const& f) {
      Vec3 x = shape_.fuselage.at(f.q, f.angle);
      if (p[1] == 0) x.y = 0;
      put(p, x);
    };
    if (face.axis == 0)
      return for_nodes(face.nodes, [&](Index3 const& p) {
        OnFuselage const f = on_cap(face, p);
        on_fuselage_.emplace(lattice_.number(p), f);
        put_at(p, f);
      });
    // Between the four edges (Gordon and Hall); an edge is given where a cap or another body has placed it, and
    // straight elsewhere.
    int const around = face.axis == 1 ? 2 : 1;
    IndexRange const& r = face.nodes;
    auto const corner_of = [&](int a, int b) {
      Index3 planes = face.cell;
      planes[face.axis] += face.side;
      planes[0] += a;
      planes[around] += b;
      return corner(planes);
    };
    OnFuselage const corners[2][2] = {{corner_of(0, 0), corner_of(0, 1)}, {corner_of(1, 0), corner_of(1, 1)}};
    auto const mean = [](OnFuselage const& a, OnFuselage const& b, double t) {
      return OnFuselage{(1 - t) * a.q + t * b.q, (1 - t) * a.angle + t * b.angle};
    };
    /// Whether all nodes of the edge at one end of an axis are placed.
    auto const given = [&](int axis, int end) {
      IndexRange edge = r;
      edge.begin[axis] = end ? r.end[axis] - 1 : r.begin[axis];
      edge.end[axis] = edge.begin[axis] + 1;
      bool all = true;
      for_nodes(edge, [&](Index3 const& p) { all = all && on_fuselage_.contains(lattice_.number(p)); });
      return all;
    };
    bool const is_given[2][2] = {{given(0, 0), given(0, 1)}, {given(around, 0), given(around, 1)}};
    auto const edge = [&](Index3 p, int end_axis, int end, double t) {
      int const which = end_axis == 0 ? 0 : 1;
      p[end_axis] = end ? r.end[end_axis] - 1 : r.begin[end_axis];
      if (is_given[which][end]) return on_fuselage_.at(lattice_.number(p));
      return end_axis == 0 ? mean(corners[end][0], corners[end][1], t) : mean(corners[0][end], corners[1][end], t);
    };
    for_nodes(r, [&](Index3 const& p) {
      if (at_.contains(lattice_.number(p))) return;
      double const s = share(face.cell, 0, p[0]);
      double const t =
          around == 1 && face.cell[1] == 0 ? even_share(face.cell, 1, p[1]) : even_share(face.cell, around, p[around]);
      OnFuselage const along = mean(edge(p, around, 0, s), edge(p, around, 1, s), t);
      OnFuselage const across = mean(edge(p, 0, 0, t), edge(p, 0, 1, t), s);
      OnFuselage const both = mean(mean(corners[0][0], corners[0][1], t), mean(corners[1][0], corners[1][1], t), s);
      put_at(p, {along.q + across.q - both.q, along.angle + across.angle - both.angle});
    });
  }
};

}  // namespace

std::vector<WallFace> wall_faces(Lattice const& lattice) {
  std::vector<WallFace> faces;
  for (int k = 0; k < k_high; ++k)
    for (int j = 0; j < j_far; ++j)
      for (int i = 0; i < i_back; ++i) {
        Index3 const cell{i, j, k};
        Part const part = body(cell);
        if (part == Part::none) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (int side : {0, 1}) {
            Index3 beside = cell;
            beside[axis] += side ? 1 : -1;
            if (beside[1] < 0 || body(beside) != Part::none) continue;
            IndexRange nodes = lattice.nodes(cell, {i + 1, j + 1, k + 1});
            if (side)
              nodes.begin[axis] = nodes.end[axis] - 1;
            else
              nodes.end[axis] = nodes.begin[axis] + 1;
            faces.push_back({part, cell, axis, side, nodes});
          }
      }
  return faces;
}

Surface::Surface(Lattice const& lattice, std::vector<WallFace> const& faces, double first_cell)
    : layers_(lattice.layers) {
  Placer placer(lattice);
  for (WallFace const& face : faces)
    if (face.part != Part::fuselage) placer.place(face);
  for (bool const caps : {true, false})
    for (WallFace const& face : faces)
      if (face.part == Part::fuselage && (face.axis == 0) == caps) placer.place(face);
  for (WallFace const& face : faces)
    Placer::for_nodes(face.nodes, [&](Index3 const& p) {
      Index const node = lattice.number(p);
      if (!number_.emplace(node, size()).second) return;
      on_body_.push_back(placer.at(node));
      on_lattice_.push_back(lattice.position(p));
      auto const s = demo::geometric_spacing(layers_, first_cell / distance(on_body_.back(), on_lattice_.back()));
      share_.insert(share_.end(), s.begin(), s.end());
    });
}

Vec3 Surface::position(int number, int layer) const {
  if (layer == 0) return on_body_[number];
  if (layer == layers_) return on_lattice_[number];
  double const s = share_[std::size_t(number) * std::size_t(layers_ + 1) + std::size_t(layer)];
  return (1 - s) * on_body_[number] + s * on_lattice_[number];
}

}  // namespace gridmorph::aircraft
