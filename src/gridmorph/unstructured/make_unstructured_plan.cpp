#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/motion/selectors.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/unstructured/background_hole.hpp>
#include <gridmorph/unstructured/column_heights.hpp>
#include <gridmorph/unstructured/detail/corner_means.hpp>
#include <gridmorph/unstructured/detail/element_grades.hpp>
#include <gridmorph/unstructured/detail/fans.hpp>
#include <gridmorph/unstructured/locate.hpp>
#include <gridmorph/unstructured/unstructured_plan.hpp>
#include <gridmorph/unstructured/wall_distance.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

namespace gridmorph {

namespace {

using Mask = std::vector<std::uint8_t>;
using Exec = Kokkos::DefaultHostExecutionSpace;
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string text(double v) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", v);
  return buffer;
}

class Planner {
 public:
  Planner(UnstructuredMesh const& mesh, UnstructuredTopology const& topology, BoundaryClaims const& claims,
          Motion const& motion, UnstructuredOptions const& options)
      : mesh_(mesh), topology_(topology), claims_(claims), motion_(motion), options_(options) {}

  PreparedUnstructured run() {
    refuse_open_faces();
    out_.plan.n_nodes = mesh_.n_nodes();
    out_.plan.dimension = mesh_.dimension;
    out_.plan.plane_normal = plane_normal(mesh_);
    if (mesh_.dimension == 2 && !(std::abs(out_.plan.plane_normal.z) == 1))
      throw MeshError("mesh " + mesh_.source + " is 2-D but does not lie in a plane z = constant; turn it into one");
    timed(out_.report.seconds.boundary, [&] { find_boundary(); });
    timed(out_.report.seconds.distances, [&] { measure_distances(); });
    timed(out_.report.seconds.columns, [&] { find_columns(); });
    timed(out_.report.seconds.wrap, [&] { find_regions(); });
    timed(out_.report.seconds.layers, [&] { plan_layers(); });
    timed(out_.report.seconds.background, [&] { plan_background(); });
    timed(out_.report.seconds.location, [&] { plan_projections(); });
    timed(out_.report.seconds.residual, [&] { plan_residual(); });
    return std::move(out_);
  }

 private:
  template <class Step>
  static void timed(double& seconds, Step&& step) {
    Stopwatch watch;
    step();
    seconds = watch.lap();
  }

  void refuse_open_faces() const {
    Problems problems;
    for (auto const& problem : claims_.problems) problems.add(problem);
    problems.throw_if_any<MeshError>();
  }

  [[nodiscard]] Mask mask() const { return Mask(std::size_t(mesh_.n_nodes()), 0); }
  [[nodiscard]] Number owner(Number n) const { return out_.graph.representative[std::size_t(n)]; }

  void find_boundary() {
    out_.graph = make_node_graph(mesh_);
    out_.boundary = boundary_conditions(mesh_, topology_, claims_, out_.graph, motion_, options_.walls);
    BoundaryConditions const& b = out_.boundary;
    UnstructuredPlan& plan = out_.plan;
    out_.notes = b.notes;
    plan.known = b.known;
    plan.surfaces = b.surfaces;
    plan.images = b.images;
    plan.rotations = b.rotations;
    is_known_ = drives_ = is_other_ = mask();
    for (std::size_t k = 0; k < b.known.size(); ++k) {
      is_known_[std::size_t(b.known[k])] = 1;
      if (b.drives[k]) {
        drives_[std::size_t(b.known[k])] = 1;
        plan.driving.push_back(b.known[k]);
        plan.driving_slots.push_back(Number(k));
      }
    }
    for (Number n = 0; n < Number(mesh_.n_nodes()); ++n)
      if (Number const o = owner(n); o != n) {
        plan.copies.push_back(n);
        plan.copied.push_back(o);
      }
    plan.middle = detail::corner_means(mesh_, out_.graph);
    reach_ = options_.motion >= 0 ? options_.motion : largest_displacement();
  }

  // ---- columns -------------------------------------------------------------------------------------------------------

  /// Faces of moving walls with the boundary layer that a user gave their patch.
  void find_driving_faces() {
    BoundaryConditions const& b = out_.boundary;
    layer_of_patch_.assign(mesh_.patches.size(), -1);
    for (std::size_t l = 0; l < options_.boundary_layers.size(); ++l) {
      auto const& layer = options_.boundary_layers[l];
      std::vector<int> const patches = layer.walls.empty() ? b.driving_patches : select_patches(b.outline, layer.walls);
      for (int const p : patches) {
        int& own = layer_of_patch_[std::size_t(p)];
        if (own >= 0)
          throw MotionError("two boundary layers name patch " + describe_patch(mesh_, mesh_.patches[std::size_t(p)]) +
                            "; give each wall one");
        own = int(l);
        if (!std::binary_search(b.driving_patches.begin(), b.driving_patches.end(), p))
          out_.notes.push_back("patch " + describe_patch(mesh_, mesh_.patches[std::size_t(p)]) +
                               " has a boundary layer but drives no near field; its columns are not held");
      }
    }
    for (Index f = 0; f < topology_.boundary.size(); ++f) {
      int const p = claims_.patch[std::size_t(f)];
      if (p >= 0 && std::binary_search(b.driving_patches.begin(), b.driving_patches.end(), p))
        driving_faces_.push_back(Number(f));
    }
    if (driving_faces_.empty())
      throw MotionError(
          "the moving walls have no faces on the boundary of the elements; their patches list nodes of other places");
  }

  void find_columns() {
    find_driving_faces();
    std::vector<ColumnExtent> extents;
    for (Number const f : driving_faces_) {
      int const l = layer_of_patch_[std::size_t(claims_.patch[std::size_t(f)])];
      if (l < 0) {
        extents.emplace_back();
      } else {
        auto const& layer = options_.boundary_layers[std::size_t(l)];
        extents.push_back({layer.extent, layer.layers, layer.thickness});
      }
    }
    columns_ = make_columns(mesh_, topology_, out_.graph, driving_faces_, extents, is_known_);
    out_.report.n_columns =
        std::count_if(columns_.height.begin(), columns_.height.end(), [](double h) { return h > 0; });
    columns_ = cut(columns_, smooth_heights(out_.graph, columns_, most_heights()));
    for (double const h : columns_.height) out_.report.layer_height = std::max(out_.report.layer_height, h);
    plan_columns();
  }

  /// Columns are as long as a user says; otherwise they leave room in gaps.
  [[nodiscard]] std::vector<double> most_heights() const {
    std::vector<double> most = gaps_ahead(mesh_.coordinates, columns_, from_other_);
    for (double& m : most)
      if (std::isfinite(m)) m = room_in_gap(m, reach_);
    for (Number const f : driving_faces_)
      if (int const l = layer_of_patch_[std::size_t(claims_.patch[std::size_t(f)])];
          l >= 0 && options_.boundary_layers[std::size_t(l)].extent != BoundaryLayer::Extent::block)
        for (Number const n : topology_.boundary.nodes[f]) most[std::size_t(owner(n))] = infinity;
    return most;
  }

  void plan_columns() {
    using Mode = BoundaryLayer::Mode;
    std::vector<Mode> mode(std::size_t(mesh_.n_nodes()), Mode::standard);
    for (Number const f : driving_faces_)
      if (int const l = layer_of_patch_[std::size_t(claims_.patch[std::size_t(f)])]; l >= 0)
        for (Number const n : topology_.boundary.nodes[f])
          mode[std::size_t(owner(n))] = options_.boundary_layers[std::size_t(l)].mode;
    UnstructuredPlan& plan = out_.plan;
    std::vector<Number> place(std::size_t(mesh_.n_nodes()), -1);
    for (std::size_t k = 0; k < plan.driving.size(); ++k) {
      place[std::size_t(plan.driving[k])] = Number(k);
      plan.turns.push_back(mode[std::size_t(plan.driving[k])] == Mode::translate ? 0 : 1);
    }
    plan.fans = detail::wall_fans(mesh_, topology_, out_.graph, driving_faces_, plan.driving);
    for (std::size_t k = 0; k < columns_.node.size(); ++k) {
      Number const root = columns_.root[k];
      double const s = std::min(1.0, columns_.above_wall[k] / columns_.height[std::size_t(root)]);
      Mode const m = mode[std::size_t(root)];
      // Smooth, and level at the wall: the first cells turn with it.
      double const turn = m == Mode::translate ? 0 : m == Mode::blend ? 1 - s * s * (3 - 2 * s) : 1;
      plan.columns.node.push_back(columns_.node[k]);
      plan.columns.root.push_back(place[std::size_t(root)]);
      plan.columns.turn.push_back(float(turn));
    }
  }

  // ---- regions -------------------------------------------------------------------------------------------------------

  void measure_distances() {
    BoundaryConditions const& b = out_.boundary;
    for (std::size_t k = 0; k < b.known.size(); ++k)
      if (!b.drives[k]) is_other_[std::size_t(b.known[k])] = 1;
    for (Number const n : b.slip_nodes) is_other_[std::size_t(n)] = 1;
    for (auto const& image : b.images) is_other_[std::size_t(image.node)] = is_other_[std::size_t(image.owner)] = 1;
    std::vector<Number> walls, others;
    for (Number n = 0; n < Number(mesh_.n_nodes()); ++n) {
      if (drives_[std::size_t(n)]) {
        walls.push_back(n);
        // Where a moving wall ends on another boundary, both are at no distance.
        is_other_[std::size_t(n)] = 0;
      } else if (is_other_[std::size_t(n)]) {
        others.push_back(n);
      }
    }
    // Each is serial; side by side they take half the time.
    Exec const exec;
    Kokkos::parallel_for("gridmorph::nearest_source", Kokkos::RangePolicy<Exec>(exec, 0, 2, Kokkos::ChunkSize(1)),
                         [&](int which) {
                           (which == 0 ? from_wall_ : from_other_) =
                               nearest_source(mesh_.coordinates, out_.graph, which == 0 ? walls : others);
                         });
    compat::fence(exec, "gridmorph::nearest_source (read by the host)");
  }

  [[nodiscard]] double largest_displacement() const {
    double largest = 0;
    for (Vec3 const& u : out_.boundary_displacement(mesh_)) largest = std::max(largest, norm(u));
    return largest;
  }

  double offset() {
    OffsetHints hints;
    hints.layer_height = out_.report.layer_height;
    hints.motion = reach_;
    double sum = 0;
    Index count = 0;
    Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (Number const f : driving_faces_) {
      auto const face = topology_.boundary.nodes[f];
      for (std::size_t k = 0; k < face.size(); ++k, ++count) {
        Vec3 const x = mesh_.coordinates[face[k]];
        sum += distance(x, mesh_.coordinates[face[(k + 1) % face.size()]]);
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
      }
    }
    hints.wall_edge = sum / double(count);
    hints.body = norm(high - low);
    // A wall that ends on another boundary has no gap to it that could limit the wrap.
    double gap = infinity;
    for (std::size_t n = 0; n < drives_.size(); ++n)
      if (drives_[n]) gap = std::min(gap, from_other_.distance[n]);
    hints.gap = std::isfinite(gap) && gap > hints.wall_edge ? gap : 0;
    return options_.offset > 0 ? options_.offset : suggest_offset(hints);
  }

  void find_regions() {
    if (options_.background)
      classify_by_background();
    else
      classify_by_wrap();
    near_ = mask();
    for (Number n = 0; n < Number(mesh_.n_nodes()); ++n)
      if (out_.report.regions.near[std::size_t(n)]) near_[std::size_t(owner(n))] = 1;
    // Columns are kept whole, wherever the wrap ends.
    for (Number const n : columns_.node) near_[std::size_t(n)] = 1;
  }

  void classify_by_wrap() {
    out_.report.offset = offset();
    NumberLists faces;
    for (Number const f : driving_faces_) faces.add(topology_.boundary.nodes[f]);
    WrapOptions wrap;
    wrap.offset = out_.report.offset;
    wrap.resolution = options_.resolution;
    wrap.tube = options_.tube;
    out_.report.wrap = make_wrap(mesh_, {&faces, 1}, wrap);
    if (std::string const& note = out_.report.wrap->note; !note.empty())
      out_.notes.push_back("the wrap is made of lattice cells: " + note);
    out_.report.regions = classify(mesh_, *out_.report.wrap);
  }

  /// The user's background mesh says where the wrap is; the moving walls must be in it.
  void classify_by_background() {
    take_background(*options_.background);
    Background const& background = *out_.plan.background;
    out_.report.regions =
        classify_by_hole(mesh_, background, wrap_nodes(background, *out_.plan.background_morph).position);
    Index astray = 0;
    Number first = -1;
    for (Number const n : out_.plan.driving)
      if (!out_.report.regions.inside[std::size_t(n)] && astray++ == 0) first = n;
    if (astray > 0)
      throw MeshError("background mesh " + background.mesh.source + " does not go around the moving walls: " +
                      std::to_string(astray) + " of their " + std::to_string(out_.plan.driving.size()) +
                      " nodes lie in its cells or beyond its wrap, such as " + describe_node(mesh_, first) +
                      "; leave a hole in it that holds them, its faces being the wrap");
  }

  void take_background(Background background) {
    out_.plan.background = std::move(background);
    out_.plan.background_morph = prepare_background(*out_.plan.background, options_.law);
  }

  // ---- layers --------------------------------------------------------------------------------------------------------

  std::function<double(Number, Number)> layer_weight() {
    auto const length = [this](Number a, Number b) {
      double const d = distance(mesh_.coordinates[a], mesh_.coordinates[b]);
      return d > 0 ? d : std::numeric_limits<double>::min();
    };
    switch (options_.weight) {
      case LayerWeight::uniform: return [](Number, Number) { return 1.0; };
      case LayerWeight::inverse_distance: return [=](Number a, Number b) { return 1 / length(a, b); };
      case LayerWeight::quality:
        return [=, grade = detail::node_grades(mesh_, topology_, out_.graph)](Number a, Number b) {
          return (grade[std::size_t(a)] + grade[std::size_t(b)]) / length(a, b);
        };
      case LayerWeight::curvature:
        return
            [=, this, bend = detail::wall_curvature(mesh_, topology_, out_.graph, driving_faces_)](Number a, Number b) {
              Number const wall = from_wall_.source[std::size_t(b)];
              double const reach = wall < 0 ? 0 : from_wall_.distance[std::size_t(b)] * bend[std::size_t(wall)];
              return 1 / (length(a, b) * (1 + reach) * (1 + reach));
            };
    }
    return [](Number, Number) { return 1.0; };
  }

  void plan_layers() {
    UnstructuredPlan& plan = out_.plan;
    Mask seeds = drives_;
    for (Number const n : columns_.node) seeds[std::size_t(n)] = 1;
    Mask wanted = near_;
    for (std::size_t n = 0; n < seeds.size(); ++n)
      if (seeds[n] || !out_.graph.carries(Number(n))) wanted[n] = 0;
    plan.near = make_layers(out_.graph, mesh_.coordinates, seeds, wanted, from_wall_.distance, layer_weight());
    plan_smooth_walls();
    auto& layer = out_.report.layer;
    layer.assign(seeds.size(), -1);
    for (std::size_t n = 0; n < seeds.size(); ++n)
      if (seeds[n]) layer[n] = 0;
    for (int l = 0; l < plan.near.n_layers(); ++l)
      for (Index r = plan.near.level[std::size_t(l)]; r < plan.near.level[std::size_t(l) + 1]; ++r) {
        layer[std::size_t(plan.near.rows.target[std::size_t(r)])] = l + 1;
        wanted[std::size_t(plan.near.rows.target[std::size_t(r)])] = 0;
      }
    out_.report.unreached = std::count(wanted.begin(), wanted.end(), 1);
    if (out_.report.unreached > 0)
      out_.notes.push_back(
          std::to_string(out_.report.unreached) +
          " nodes lie in the wrap but are joined to no moving wall by edges of elements; they follow the other "
          "boundaries alone");
  }

  /// The smooth part covers the wrap; what it misses fades over a few of its cells.
  void plan_smooth_walls() {
    UnstructuredPlan& plan = out_.plan;
    Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (Number n = 0; n < Number(mesh_.n_nodes()); ++n) {
      if (!near_[std::size_t(n)]) continue;
      Vec3 const x = mesh_.coordinates[n];
      low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
      high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    plan.walls = make_scatter_lattice(mesh_.coordinates, plan.driving, areas(plan.driving), mesh_.dimension, low, high);
    double const reach = 4 * plan.walls.shape.spacing;
    for (Number const n : plan.near.rows.target) {
      double const s = std::min(1.0, beyond_column(std::size_t(n)) / reach);
      plan.near_fade.push_back(float(1 - s * s * (3 - 2 * s)));
    }
  }

  /// Distance from the end of the column on the nearest wall node.
  [[nodiscard]] double beyond_column(std::size_t n) const {
    Number const wall = from_wall_.source[n];
    return wall < 0 ? infinity : std::max(0.0, from_wall_.distance[n] - columns_.height[std::size_t(wall)]);
  }

  // ---- background ----------------------------------------------------------------------------------------------------

  void plan_background() {
    UnstructuredPlan& plan = out_.plan;
    if (!plan.background) {
      if (out_.report.regions.n_far == 0) return;
      take_background(make_background(*out_.report.wrap, options_.cells));
    }
    plan_outer_box();
  }

  /// The outer box moves as the prescribed boundary nearest to it: a mesh that is shifted as a whole is shifted exactly.
  void plan_outer_box() {
    UnstructuredPlan& plan = out_.plan;
    // Any choice is made good by the residual, so a few thousand places to choose from are enough.
    constexpr std::size_t most = 2000;
    std::vector<Number> slots;
    for (std::size_t k = 0; k < plan.known.size(); ++k)
      if (!out_.boundary.drives[k]) slots.push_back(Number(k));
    if (slots.empty()) return;
    std::size_t const step = slots.size() / most + 1;
    WrapNodes const wrap = wrap_nodes(*plan.background, *plan.background_morph);
    auto const& nodes = plan.background_morph->plan().boundary_nodes;
    Mask is_wrap(nodes.size(), 0);
    for (Number const b : wrap.boundary_node) is_wrap[std::size_t(b)] = 1;
    for (std::size_t b = 0; b < nodes.size(); ++b) {
      if (is_wrap[b]) continue;
      Vec3 x = plan.background->mesh.coordinates[nodes[b]];
      if (mesh_.dimension == 2) x.z = 0;
      Number best = -1;
      double nearest = infinity;
      for (std::size_t k = 0; k < slots.size(); k += step)
        if (double const d = distance(x, mesh_.coordinates[plan.known[std::size_t(slots[k])]]); d < nearest) {
          nearest = d;
          best = slots[k];
        }
      double const one = 1;
      plan.outer.add(Number(b), {&best, 1}, {&one, 1});
    }
  }

  void plan_projections() {
    UnstructuredPlan& plan = out_.plan;
    if (!plan.background) return;
    project_wrap();
    // Beyond the wrap the background mesh has the say, on the fence too: layers went there only to surround the wrap's nodes.
    Mask column = drives_;
    for (Number const n : columns_.node) column[std::size_t(n)] = 1;
    std::vector<Number> far;
    for (Number n = 0; n < Number(mesh_.n_nodes()); ++n)
      if (out_.graph.carries(n) && !out_.graph.neighbours[n].empty() && !column[std::size_t(n)] &&
          !out_.report.regions.inside[std::size_t(n)])
        far.push_back(n);
    FarRows rows = background_rows(*plan.background, mesh_.coordinates, far);
    out_.report.far_nodes = Index(far.size());
    out_.report.far_outside = rows.n_outside;
    plan.far = std::move(rows.rows);
  }

  /// Wrap nodes in the elements that hold them; rows name representatives, so that layers reach their nodes.
  void project_wrap() {
    UnstructuredPlan& plan = out_.plan;
    WrapNodes const wrap = wrap_nodes(*plan.background, *plan.background_morph);
    std::vector<Number> candidates;
    for (Index e = 0; e < mesh_.n_elements(); ++e)
      if (out_.report.regions.element[std::size_t(e)] != Region::far) candidates.push_back(Number(e));
    Kokkos::View<Vec3*, Kokkos::HostSpace> points("gridmorph::wrap_nodes", wrap.position.size());
    std::copy(wrap.position.begin(), wrap.position.end(), points.data());
    Kokkos::View<Location*, Kokkos::HostSpace> found("gridmorph::wrap_locations", wrap.position.size());
    Exec const exec;
    ElementLocator<Exec> const locator(exec, mesh_, candidates);
    locator.locate(exec, points, found);
    compat::fence(exec, "gridmorph::locate wrap nodes");
    plan.wrap = interpolation_rows(mesh_, {found.data(), found.extent(0)}, wrap.boundary_node);
    for (Number& n : plan.wrap.item) n = owner(n);
    out_.report.wrap_nodes = Index(wrap.position.size());
    for (std::size_t n = 0; n < found.extent(0); ++n)
      if (found(n).distance > 0) {
        ++out_.report.wrap_outside;
        out_.report.wrap_distance = std::max(out_.report.wrap_distance, found(n).distance);
      }
    if (out_.report.wrap_outside > 0)
      out_.notes.push_back(std::to_string(out_.report.wrap_outside) + " of " + std::to_string(out_.report.wrap_nodes) +
                           " nodes of the wrap lie outside all elements (in solids or beyond the domain), at most " +
                           text(out_.report.wrap_distance) + " away; they move as the nearest place of an element");
  }

  std::function<double(Number, Number)> inverse_distance() const {
    return [this](Number a, Number b) {
      double const d = distance(mesh_.coordinates[a], mesh_.coordinates[b]);
      return 1 / std::max(d, std::numeric_limits<double>::min());
    };
  }

  // ---- residual ------------------------------------------------------------------------------------------------------

  void plan_residual() {
    UnstructuredPlan& plan = out_.plan;
    plan_other_nodes();
    plan.fade.assign(is_other_.size(), 0);
    for (std::size_t n = 0; n < is_other_.size(); ++n)
      if (out_.graph.carries(Number(n)) && !drives_[n] && !is_other_[n]) plan.fade[n] = float(fade(n));
    // Columns are as rigid as their walls ask for.
    for (Number const n : columns_.node) plan.fade[std::size_t(n)] = 0;
    MeshExtent const box = extent_of(mesh_.coordinates);
    plan.residual =
        make_scatter_lattice(mesh_.coordinates, plan.other, areas(plan.other), mesh_.dimension, box.low, box.high);
    if (plan.residual.empty()) return;
    double const reach = 2 * plan.residual.shape.spacing;
    Mask wanted = mask();
    for (std::size_t n = 0; n < wanted.size(); ++n)
      wanted[n] = plan.fade[n] != 0 && from_other_.distance[n] < reach ? 1 : 0;
    plan.residual_detail =
        make_layers(out_.graph, mesh_.coordinates, is_other_, wanted, from_other_.distance, inverse_distance());
    for (Number const n : plan.residual_detail.rows.target) {
      double const s = from_other_.distance[std::size_t(n)] / reach;
      plan.detail_fade.push_back(float(plan.fade[std::size_t(n)] * (1 - s * s * (3 - 2 * s))));
    }
  }

  /// Share of each node in the area of the boundary; nodes that are on no boundary face have a mean one.
  [[nodiscard]] std::vector<double> areas(std::vector<Number> const& nodes) const {
    std::vector<double> area(std::size_t(mesh_.n_nodes()), 0);
    for (Index f = 0; f < topology_.boundary.size(); ++f) {
      auto const face = topology_.boundary.nodes[f];
      Vec3 const a = mesh_.coordinates[face[0]];
      double size = 0;
      if (mesh_.dimension == 2) size = distance(a, mesh_.coordinates[face[1]]);
      for (std::size_t k = 1; mesh_.dimension == 3 && k + 1 < face.size(); ++k)
        size += 0.5 * norm(cross(mesh_.coordinates[face[k]] - a, mesh_.coordinates[face[k + 1]] - a));
      for (Number const n : face) area[std::size_t(owner(n))] += size / double(face.size());
    }
    double sum = 0;
    Index count = 0;
    for (double const a : area)
      if (a > 0) {
        sum += a;
        ++count;
      }
    double const mean = count > 0 ? sum / double(count) : 1;
    std::vector<double> out;
    for (Number const n : nodes) out.push_back(area[std::size_t(n)] > 0 ? area[std::size_t(n)] : mean);
    return out;
  }

  [[nodiscard]] double fade(std::size_t n) const {
    double const other = from_other_.distance[n];
    if (!std::isfinite(other)) return 0;
    double const d = beyond_column(n);
    if (!std::isfinite(d)) return 1;
    return d + other > 0 ? d / (d + other) : 0;
  }

  void plan_other_nodes() {
    UnstructuredPlan& plan = out_.plan;
    BoundaryConditions const& b = out_.boundary;
    std::vector<Number> slot(std::size_t(mesh_.n_nodes()), -1), slip(std::size_t(mesh_.n_nodes()), -1);
    for (std::size_t k = 0; k < b.known.size(); ++k) slot[std::size_t(b.known[k])] = Number(k);
    for (std::size_t k = 0; k < b.slip_nodes.size(); ++k) slip[std::size_t(b.slip_nodes[k])] = Number(k);
    for (Number n = 0; n < Number(mesh_.n_nodes()); ++n) {
      if (!is_other_[std::size_t(n)]) continue;
      plan.other.push_back(n);
      plan.other_slot.push_back(slot[std::size_t(n)]);
      if (slip[std::size_t(n)] >= 0) {
        plan.other_surfaces.add(b.slip_surfaces[slip[std::size_t(n)]]);
      } else {
        plan.other_surfaces.add({});
      }
    }
    std::vector<std::pair<Number, Number>> by_owner;
    for (std::size_t k = 0; k < b.images.size(); ++k) by_owner.emplace_back(b.images[k].owner, Number(k));
    std::sort(by_owner.begin(), by_owner.end());
    for (std::size_t k = 0; k < by_owner.size();) {
      std::vector<Number> images;
      Number const o = by_owner[k].first;
      for (; k < by_owner.size() && by_owner[k].first == o; ++k) images.push_back(by_owner[k].second);
      plan.image_owners.push_back(o);
      plan.images_of_owner.add(images);
    }
  }

  UnstructuredMesh const& mesh_;
  UnstructuredTopology const& topology_;
  BoundaryClaims const& claims_;
  Motion const& motion_;
  UnstructuredOptions const& options_;
  PreparedUnstructured out_;
  std::vector<int> layer_of_patch_;
  std::vector<Number> driving_faces_;
  Columns columns_;
  Mask is_known_, drives_, is_other_, near_;
  NearestSource from_wall_, from_other_;
  double reach_ = 0;  ///< largest displacement that the offset and columns reckon with
};

}  // namespace

PreparedUnstructured prepare(UnstructuredMesh const& mesh, UnstructuredTopology const& topology,
                             BoundaryClaims const& claims, Motion const& motion, UnstructuredOptions const& options) {
  return Planner(mesh, topology, claims, motion, options).run();
}

}  // namespace gridmorph
