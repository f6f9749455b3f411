#include <gridmorph/morph/share_contents.hpp>

#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace gridmorph {
namespace {

/// Appends values to bytes.
class Writer {
 public:
  template <class T>
  void plain(T const& value) {
    append(&value, sizeof value);
  }
  template <class T>
  void list(std::vector<T> const& values) {
    plain(values.size());
    append(values.data(), values.size() * sizeof(T));
  }
  [[nodiscard]] Bytes result() { return std::move(bytes_); }

 private:
  void append(void const* from, std::size_t n) {
    auto const* const first = static_cast<std::byte const*>(from);
    bytes_.insert(bytes_.end(), first, first + n);
  }
  Bytes bytes_;
};

/// Takes them off again, in the same order.
class Reader {
 public:
  explicit Reader(std::span<std::byte const> bytes) : left_(bytes) {}

  template <class T>
  void plain(T& value) {
    take(&value, sizeof value);
  }
  template <class T>
  void list(std::vector<T>& values) {
    std::size_t n = 0;
    plain(n);
    values.resize(n);
    take(values.data(), n * sizeof(T));
  }

 private:
  void take(void* to, std::size_t n) {
    if (n > 0) std::memcpy(to, left_.data(), n);
    left_ = left_.subspan(n);
  }
  std::span<std::byte const> left_;
};

// What follows says once what belongs to each, for both ways.

template <class Way, class T>
void carry(Way& way, T& value) {
  static_assert(std::is_trivially_copyable_v<std::remove_const_t<T>>, "say what belongs to it");
  way.plain(value);
}
template <class Way, class List>
void carry_items(Way& way, List& list) {
  using Item = typename List::value_type;
  if constexpr (std::is_trivially_copyable_v<Item>) {
    way.list(list);
  } else {
    std::size_t n = list.size();
    way.plain(n);
    if constexpr (!std::is_const_v<List>) list.resize(n);
    for (auto& item : list) carry(way, item);
  }
}
template <class Way, class T>
void carry(Way& way, std::vector<T>& list) {
  carry_items(way, list);
}
template <class Way, class T>
void carry(Way& way, std::vector<T> const& list) {
  carry_items(way, list);
}
template <class Way, class... Members>
void carry_all(Way& way, Members&... members) {
  (carry(way, members), ...);
}

/// T, or T that is not to be changed.
template <class T, class Of>
concept Is = std::is_same_v<std::remove_const_t<T>, Of>;

template <class Way, Is<LineTables> T>
void carry(Way& way, T& v) {
  carry_all(way, v.chains, v.n_parameters, v.n_end_values, v.end_positions, v.end_pivots, v.swept_positions);
}
template <class Way, Is<SideTables> T>
void carry(Way& way, T& v) {
  carry_all(way, v.sides, v.junctions, v.lines, v.corrected, v.gathers, v.t, v.section, v.positions);
}
template <class Way, Is<Stage> T>
void carry(Way& way, T& v) {
  std::vector<char> name(v.name.begin(), v.name.end());
  carry_all(way, v.lines, v.sides, v.ends, v.sweeps, v.volume, v.near_field, v.turns, name);
  if constexpr (!std::is_const_v<T>) v.name.assign(name.begin(), name.end());
}
template <class Way, Is<SpreadPass> T>
void carry(Way& way, T& v) {
  carry_all(way, v.lines, v.ends, v.positions, v.sweeps, v.volume);
}
template <class Way, Is<TurnTables> T>
void carry(Way& way, T& v) {
  carry_all(way, v.roots, v.neighbours, v.ends, v.end_walls, v.bodies.root, v.bodies.weight, v.bodies.first,
            v.bodies.first_chunk);
}
template <class Way, Is<CommonPart> T>
void carry(Way& way, T& v) {
  carry_all(way, v.zones, v.motion.frame, v.motion.projection, v.motion.position, v.motion.weight, v.map, v.boundary,
            v.slots, v.position);
}
template <class Way, Is<SlipSurface> T>
void carry(Way& way, T& v) {
  carry_all(way, v.kind, v.origin, v.direction, v.profile.knots, v.profile.bucket_piece, v.profile.deviation,
            v.baseline_deviation, v.size, v.frame);
  carry_all(way, v.facets.points, v.facets.normals, v.facets.bends, v.facets.facets, v.facets.boxes);
}
template <class Way, Is<Plan> T>
void carry(Way& way, T& v) {
  carry_all(way, v.boundary_nodes, v.boundary_slots, v.boundary_projections, v.stages, v.spreads, v.skeleton_nodes,
            v.boxes, v.turns, v.common, v.law_knots, v.surfaces, v.rotations, v.n_nodes, v.n_slots, v.mesh_size,
            v.line_parameters);
}

template <class Way, Is<SmoothingMap> T>
void carry(Way& way, T& v) {
  carry_all(way, v.n_modes, v.n_records, v.largest_shift, v.misfit, v.n_nodes, v.n_boundary, v.gauge, v.node, v.shift,
            v.slides, v.slide_shift, v.slide_nodes, v.surfaces);
}
template <class Way, Is<ShareContents> T>
void carry(Way& way, T& v) {
  bool has_smoothing = v.smoothing != nullptr;
  carry_all(way, v.chains, v.places, v.displacement, has_smoothing);
  if (!has_smoothing) return;
  if constexpr (std::is_const_v<T>) {
    carry(way, *v.smoothing);
  } else {
    auto const smoothing = std::make_shared<SmoothingMap>();
    carry(way, *smoothing);
    v.smoothing = smoothing;
  }
}

}  // namespace

Bytes to_bytes(ShareContents const& share) {
  Writer out;
  carry(out, share);
  return out.result();
}

ShareContents share_from_bytes(std::span<std::byte const> bytes) {
  ShareContents out;
  Reader in(bytes);
  carry(in, out);
  return out;
}

}  // namespace gridmorph
