#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_many.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mapping/detail/point_clouds.hpp>
#include <gridmorph/mapping/facet_map.hpp>
#include <gridmorph/mapping/point_field.hpp>
#include <gridmorph/mapping/point_map.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>

namespace gridmorph {

namespace {

/// The number of nodes that leave-one-out tries, at most.
constexpr std::size_t largest_sample = 2000;

struct PositionHash {
  std::size_t operator()(Vec3 const& p) const {
    std::uint64_t h = 0;
    for (double const v : {p.x, p.y, p.z}) {
      h = (h ^ std::bit_cast<std::uint64_t>(v == 0 ? 0.0 : v)) * 0x9e3779b97f4a7c15ull;  // 0.0 == -0.0
      h ^= h >> 32;
    }
    return std::size_t(h);
  }
};

}  // namespace

struct PointField::Impl {
  StructuralModel model;
  FieldOptions options;
  std::vector<std::vector<Vec3>> fields;
  std::optional<PointMap> points;
  std::optional<FacetMap> facets;

  mutable std::mutex turn;
  mutable std::unordered_map<Vec3, Stencil, PositionHash> kept;
  mutable MappingDistance mapping;
  mutable double sum = 0;

  mutable double patches_size = 0, slack = 0;

  void scale();
  [[nodiscard]] double largest_displacement() const;
  [[nodiscard]] Box box() const;
  /// Throws the MotionError about a model that lies elsewhere than the patches.
  [[noreturn]] void refuse(std::string const& what) const;
  void judge_distance(Vec3 const& q, double d) const;
  void judge_left_out(MappingDistance const& nodes) const;
  void check(Vec3 const& q, Stencil const& stencil) const;
  [[nodiscard]] Stencil make(Vec3 const& q) const;
  [[nodiscard]] std::vector<Vec3> sum_of(std::span<double const> factors) const;
  [[nodiscard]] std::vector<Vec3> rotations(std::vector<Vec3> const& field) const;
  void evaluate(std::vector<Vec3> const& field, std::span<Vec3 const> points, std::span<Vec3> displacement,
                bool iterates) const;
  /// The kept stencils of positions, made where there is none yet; `turn` is taken.
  [[nodiscard]] std::vector<Stencil const*> kept_stencils(std::span<Vec3 const> at) const;
};

void PointField::Impl::scale() {
  PointCloud& nodes = model.nodes;
  double const s = options.length_scale * options.factor;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (options.length_scale != 1) nodes.position[i] = options.length_scale * nodes.position[i];
    bool finite = std::isfinite(norm(nodes.position[i]));
    for (auto& field : fields) {
      if (s != 1) field[i] = s * field[i];
      finite = finite && std::isfinite(norm(field[i]));
    }
    if (!finite) throw ConfigError(nodes.where(i) + ": position or displacement is not finite after scaling");
  }
}

void PointField::Impl::check(Vec3 const& q, Stencil const& stencil) const {
  auto const refuse = [&](double d, std::string const& from, std::string_view key, double limit) {
    throw MotionError(
        fmt::format("{}: the node at {} is {:.6g} {}, farther than {} = {:.6g}; check units and position of the file",
                    model.nodes.source, to_text(q, 9), d, from, key, limit));
  };
  if (options.max_distance > 0 && stencil.distance > options.max_distance) {
    auto const place = model.nodes.line[points->nearest(q).first];
    refuse(stencil.distance, facets ? "from the elements" : fmt::format("from the nearest point (line {})", place),
           "max_distance", options.max_distance);
  }
  if (options.max_extrapolation >= 0 && stencil.beyond > options.max_extrapolation)
    refuse(stencil.beyond, facets ? "beyond the edge of the elements" : "beyond the edge of the points",
           "max_extrapolation", options.max_extrapolation);
}

double PointField::Impl::largest_displacement() const {
  double out = 0;
  for (auto const& field : fields)
    for (Vec3 const& u : field) out = std::max(out, norm(u));
  return out;
}

Box PointField::Impl::box() const {
  Box out;
  for (Vec3 const& p : model.nodes.position) out.include(p);
  return out;
}

namespace {

std::string span_text(Box const& box) { return fmt::format("{} to {}", to_text(box.low, 4), to_text(box.high, 4)); }

/// Ratios of lengths in other units that people mix up.
struct Units {
  double ratio;
  char const* names;
};
constexpr std::array<Units, 4> mixed_up{
    {{1000, "mm and m"}, {25.4, "mm and inch"}, {39.37, "inch and m"}, {3.281, "foot and m"}}};

/// "; the file is 1000 times as large, as mm and m: length_scale = 0.001"
std::string units_hint(double model, double patches, double length_scale) {
  constexpr double alike = 0.1;
  if (!(model > 0) || !(patches > 0)) return {};
  for (Units const& u : mixed_up)
    for (bool const larger : {true, false}) {
      double const ratio = larger ? u.ratio : 1 / u.ratio;
      if (std::fabs(model / patches / ratio - 1) < alike)
        return fmt::format("; its size is {:.4g} times theirs, as with {}: length_scale = {:.4g} would fit",
                           model / patches, u.names, length_scale / ratio);
    }
  return {};
}

}  // namespace

void PointField::Impl::refuse(std::string const& what) const {
  Box const own = box();
  throw MotionError(
      fmt::format("{}: {}; the points of the file lie from {}{}. Check length_scale, the order and signs of its "
                  "columns, frame, and whether "
                  "the file is whole; max_distance, the largest distance that is meant, allows more",
                  model.nodes.source, what, span_text(own),
                  units_hint(distance(own.low, own.high), patches_size, options.length_scale)));
}

void PointField::Impl::judge_distance(Vec3 const& q, double d) const {
  if (options.max_distance > 0 || patches_size == 0 || d <= MappingLimits::distance * patches_size + slack) return;
  refuse(fmt::format(
      "the node at {} is {:.4g} from the {}, {:.3g} % of the size {:.4g} of its patches, more than {:.3g} %",
      to_text(q, 6), d, facets ? "elements" : "nearest point", 100 * d / patches_size, patches_size,
      100 * MappingLimits::distance));
}

void PointField::Impl::judge_left_out(MappingDistance const& nodes) const {
  std::int64_t const count = left_out(nodes);
  if (options.max_distance > 0 || patches_size == 0 || slack > 0 ||
      double(count) <= MappingLimits::far_beyond * double(nodes.evaluated))
    return;
  std::string const where =
      lacks_own_nodes(nodes)
          ? fmt::format("are farther than two spacings from its points, {} of which are nodes themselves",
                        nodes.coincident)
      : facets ? "lie beyond the edge of its elements by more than two of them there"
               : "lie beyond the edge of its points by more than two spacings there";
  refuse(fmt::format("{} of {} nodes {}, more than {:.3g} %", count, nodes.evaluated, where,
                     100 * MappingLimits::far_beyond));
}

Stencil PointField::Impl::make(Vec3 const& q) const {
  if (!std::isfinite(norm(q)))
    throw MotionError(fmt::format("{}: asked for the displacement at ({}, {}, {}), which is not finite",
                                  model.nodes.source, q.x, q.y, q.z));
  Stencil out = facets ? facets->stencil(q) : points->stencil(q);
  if (!out.coincident) check(q, out);
  return out;
}

namespace {

void count(MappingDistance& to, double& sum, Vec3 const& q, Stencil const& stencil) {
  if (stencil.distance > to.max || to.evaluated == 0) {
    to.max = stencil.distance;
    to.farthest = q;
  }
  if (stencil.beyond > 0) {
    ++to.extrapolated;
    if (stencil.beyond > to.max_beyond) {
      to.max_beyond = stencil.beyond;
      to.farthest_beyond = q;
    }
  }
  ++to.evaluated;
  to.coincident += stencil.coincident ? 1 : 0;
  to.far_beyond += stencil.far_beyond ? 1 : 0;
  to.far_off += stencil.far_off ? 1 : 0;
  sum += stencil.distance;
}

}  // namespace

std::vector<Vec3> PointField::Impl::rotations(std::vector<Vec3> const& field) const {
  return facets && options.turn_offset ? nodal_rotations(model, field) : std::vector<Vec3>();
}

std::vector<Vec3> PointField::Impl::sum_of(std::span<double const> factors) const {
  std::vector<Vec3> sum(model.nodes.size());
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f] == 0) continue;
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += factors[f] * fields[f][n];
  }
  return sum;
}

std::vector<Stencil const*> PointField::Impl::kept_stencils(std::span<Vec3 const> at) const {
  std::vector<Stencil const*> out(at.size());
  detail::for_many("gridmorph::point_field::look_up", Index(at.size()), [&](Index n) {
    auto const known = kept.find(at[n]);
    out[n] = known == kept.end() ? nullptr : &known->second;
  });
  std::vector<std::size_t> missing;
  for (std::size_t n = 0; n < at.size(); ++n)
    if (out[n] == nullptr) missing.push_back(n);
  std::vector<Stencil> made(missing.size());
  detail::for_many("gridmorph::point_field::make", Index(made.size()),
                   [&](Index k) { made[k] = make(at[missing[k]]); });
  for (std::size_t k = 0; k < made.size(); ++k) {
    Vec3 const& q = at[missing[k]];
    auto const [known, fresh] = kept.try_emplace(q, std::move(made[k]));
    if (fresh) count(mapping, sum, q, known->second);
    out[missing[k]] = &known->second;
  }
  return out;
}

void PointField::Impl::evaluate(std::vector<Vec3> const& field, std::span<Vec3 const> at, std::span<Vec3> displacement,
                                bool iterates) const {
  std::vector<Vec3> const rotation = rotations(field);
  auto const all = Index(at.size());
  if (iterates) {
    detail::for_many("gridmorph::point_field::iterate", all,
                     [&](Index n) { displacement[n] = apply(make(at[n]), field, rotation); });
    return;
  }
  if (options.keep) {
    std::lock_guard const lock(turn);
    std::vector<Stencil const*> const stencils = kept_stencils(at);
    detail::for_many("gridmorph::point_field::apply", all,
                     [&](Index n) { displacement[n] = apply(*stencils[n], field, rotation); });
    return;
  }
  MappingDistance here;
  double here_sum = 0;
  constexpr Index at_once = 65536;  // some ten megabytes of stencils
  std::vector<Stencil> stencils(std::size_t(std::min(all, at_once)));
  for (Index begin = 0; begin < all; begin += at_once) {
    Index const count_of = std::min(all - begin, at_once);
    detail::for_many("gridmorph::point_field::evaluate", count_of, [&](Index n) {
      stencils[n] = make(at[begin + n]);
      displacement[begin + n] = apply(stencils[n], field, rotation);
    });
    for (Index n = 0; n < count_of; ++n) count(here, here_sum, at[begin + n], stencils[n]);
  }
  std::lock_guard const lock(turn);
  if (here.max > mapping.max || mapping.evaluated == 0) {
    mapping.max = here.max;
    mapping.farthest = here.farthest;
  }
  if (here.max_beyond > mapping.max_beyond) {
    mapping.max_beyond = here.max_beyond;
    mapping.farthest_beyond = here.farthest_beyond;
  }
  mapping.evaluated += here.evaluated;
  mapping.coincident += here.coincident;
  mapping.extrapolated += here.extrapolated;
  mapping.far_beyond += here.far_beyond;
  mapping.far_off += here.far_off;
  sum += here_sum;
}

PointField::PointField(PointCloud cloud, FieldOptions const& options)
    : PointField(StructuralModel{std::move(cloud), {}, {}, {}}, options) {}

PointField::PointField(StructuralModel model, FieldOptions const& options, std::vector<std::vector<Vec3>> further)
    : impl_(std::make_unique<Impl>()) {
  if (model.nodes.size() == 0)
    throw ConfigError(model.nodes.source + ": holds no points; expected lines of x, y, z, dx, dy, dz");
  impl_->options = options;
  impl_->fields.push_back(std::move(model.nodes.displacement));
  for (auto& field : further) impl_->fields.push_back(std::move(field));
  model.nodes.imaginary.clear();
  impl_->model = std::move(model);
  impl_->scale();
  mapping::merge_nodes(impl_->model, impl_->fields);
  impl_->points.emplace(impl_->model.nodes.position, options.extrapolation);
  if (!impl_->model.facets.empty())
    impl_->facets.emplace(impl_->model, options.extrapolation, impl_->points->coincidence());
}

PointField::~PointField() = default;
PointField::PointField(PointField&&) noexcept = default;
PointField& PointField::operator=(PointField&&) noexcept = default;

void PointField::operator()(std::span<Vec3 const> points, std::span<Vec3> displacement) const {
  impl_->evaluate(impl_->fields.front(), points, displacement, false);
}

void PointField::evaluate(std::span<double const> factors, std::span<Vec3 const> points, std::span<Vec3> displacement,
                          bool iterates) const {
  impl_->evaluate(impl_->sum_of(factors), points, displacement, iterates);
}

void PointField::held(std::span<double const> factors, std::span<Vec3 const> points, std::span<Vec3 const> anchors,
                      std::span<Vec3> displacement) const {
  std::vector<Vec3> const field = impl_->sum_of(factors), rotation = impl_->rotations(field);
  for (std::size_t n = 0; n < points.size(); ++n)
    displacement[n] = apply(
        impl_->facets ? impl_->facets->stencil(points[n], anchors[n]) : impl_->points->stencil(points[n], anchors[n]),
        field, rotation);
}

std::size_t PointField::size() const { return impl_->model.nodes.size(); }
std::size_t PointField::n_elements() const { return impl_->model.facets.size(); }
std::size_t PointField::n_fields() const { return impl_->fields.size(); }
double PointField::coincidence() const { return impl_->points->coincidence(); }
std::string const& PointField::source() const { return impl_->model.nodes.source; }
std::string PointField::where(std::size_t node) const { return impl_->model.nodes.where(node); }
std::vector<std::string> const& PointField::notes() const { return impl_->model.notes; }

bool lacks_own_nodes(MappingDistance const& mapping) {
  return double(mapping.coincident) >= MappingLimits::own_nodes * double(mapping.evaluated) &&
         double(mapping.far_off) > MappingLimits::whole_parts * double(mapping.evaluated - mapping.coincident);
}

std::int64_t left_out(MappingDistance const& mapping) {
  return lacks_own_nodes(mapping) ? std::max(mapping.far_off, mapping.far_beyond) : mapping.far_beyond;
}

MappingDistance PointField::mapping() const {
  std::lock_guard const lock(impl_->turn);
  MappingDistance all = impl_->mapping;
  if (all.evaluated > 0) all.mean = impl_->sum / double(all.evaluated);
  all.patches_size = impl_->patches_size;
  return all;
}

bool PointField::has_max_distance() const { return impl_->options.max_distance > 0; }
double PointField::largest_displacement() const { return impl_->largest_displacement(); }

void PointField::expect(std::span<Vec3 const> nodes, double slack) const {
  Box box;
  for (Vec3 const& p : nodes) box.include(p);
  if (nodes.empty()) return;
  impl_->patches_size = std::max(impl_->patches_size, distance(box.low, box.high));
  impl_->slack = slack;
  if (impl_->options.max_distance > 0 || impl_->patches_size == 0) return;
  constexpr std::size_t most = 4000;
  std::size_t const step = (nodes.size() + most - 1) / most;
  // Distances first: they take less than a search for neighbours far away.
  Vec3 worst;
  double largest = 0;
  for (std::size_t n = 0; n < nodes.size(); n += step) {
    double const d = impl_->points->nearest(nodes[n]).second;
    if (!(d > largest)) continue;
    largest = d;
    worst = nodes[n];
  }
  if (largest > MappingLimits::distance * impl_->patches_size + slack)
    impl_->judge_distance(worst, impl_->facets ? impl_->facets->stencil(worst).distance : largest);
  MappingDistance looked_at;
  double sum = 0;
  for (std::size_t n = 0; n < nodes.size(); n += step) {
    Stencil const stencil = impl_->make(nodes[n]);
    impl_->judge_distance(nodes[n], stencil.distance);
    count(looked_at, sum, nodes[n], stencil);
  }
  impl_->judge_left_out(looked_at);
}

void PointField::judge() const {
  MappingDistance const m = mapping();
  if (m.evaluated == 0) return;
  impl_->judge_distance(m.farthest, m.max);
  impl_->judge_left_out(m);
}

MappingError PointField::leave_one_out() const {
  MappingError worst;
  auto const& position = impl_->model.nodes.position;
  if (position.size() < 3) return worst;
  std::vector<double> largest, square(impl_->fields.size(), 0.0);
  for (auto const& field : impl_->fields) {
    double size = 0;
    for (Vec3 const& u : field) size = std::max(size, norm(u));
    largest.push_back(size);
  }
  // Evenly through the file, whatever its order.
  std::size_t const step = (position.size() + largest_sample - 1) / largest_sample;
  for (std::size_t n = 0; n < position.size(); n += step) {
    Stencil const stencil = impl_->points->stencil(position[n], n);
    ++worst.tried;
    for (std::size_t f = 0; f < impl_->fields.size(); ++f) {
      if (largest[f] == 0) continue;
      double const error = distance(apply(stencil, impl_->fields[f], {}), impl_->fields[f][n]) / largest[f];
      square[f] += error * error;
      if (error <= worst.max) continue;
      worst.max = error;
      worst.worst = n;
    }
  }
  worst.rms = std::sqrt(*std::max_element(square.begin(), square.end()) / double(worst.tried));
  return worst;
}

}  // namespace gridmorph
