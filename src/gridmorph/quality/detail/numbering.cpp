#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

/// +1 where two elements name the side between them in opposite ways, as neighbours numbered alike do, -1 where in the
/// same way, 0 where it cannot be told.
int alike(std::span<Index32 const> own, std::span<Index32 const> other) {
  std::size_t const n = own.size();
  if (n != other.size() || n < 2) return 0;
  auto const at = std::find(other.begin(), other.end(), own[0]);
  if (at == other.end()) return 0;
  std::size_t const k = std::size_t(at - other.begin());
  if (n == 2) return k == 1 ? 1 : -1;
  if (other[(k + n - 1) % n] == own[1]) return 1;
  return other[(k + 1) % n] == own[1] ? -1 : 0;
}

class Numbering {
 public:
  Numbering(Mesh const& mesh, ElementSides const& sides, std::vector<signed char> const& volume)
      : mesh_(mesh), sides_(sides), volume_(volume), sign_(volume.size(), 0) {}

  std::vector<signed char> run() {
    for (auto const& zone : mesh_.zones) {
      auto const begin = volume_.begin() + zone.first_element, end = begin + zone.n_elements;
      if (std::find(begin, end, -1) == end)
        fill(zone, 1);
      else if (std::find(begin, end, 1) == end)
        fill(zone, -1);
      else
        for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e)
          if (sign_[e] == 0) follow(e);
    }
    return std::move(sign_);
  }

 private:
  void fill(Zone const& zone, signed char sign) {
    for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e) sign_[e] = sign;
  }

  /// How element e names its side s against how its neighbour does.
  [[nodiscard]] int across(Index32 e, int s, Index32 neighbour) const {
    std::array<Index32, max_face_corners> room, other_room;
    auto const own = side_nodes(mesh_, e, s, room);
    auto const back = sides_.of(neighbour);
    for (int t = 0; t < int(back.size()); ++t)
      if (back[t] == e)
        if (int const found = alike(own, side_nodes(mesh_, neighbour, t, other_room)); found != 0) return found;
    return 0;
  }

  /// Signs of all elements that hang together with e.
  void follow(Index first) {
    members_.assign(1, Index32(first));
    sign_[first] = 1;
    Index balance = volume_[first];
    for (std::size_t m = 0; m < members_.size(); ++m) {
      Index32 const e = members_[m];
      auto const neighbours = sides_.of(e);
      for (int s = 0; s < int(neighbours.size()); ++s) {
        Index32 const n = neighbours[s];
        if (n < 0 || sign_[n] != 0) continue;
        int const same = across(e, s, n);
        if (same == 0) continue;
        sign_[n] = static_cast<signed char>(same * sign_[e]);
        balance += sign_[n] * volume_[n];
        members_.push_back(n);
      }
    }
    if (balance < 0)
      for (Index32 const e : members_) sign_[e] = static_cast<signed char>(-sign_[e]);
  }

  Mesh const& mesh_;
  ElementSides const& sides_;
  std::vector<signed char> const& volume_;
  std::vector<signed char> sign_;
  std::vector<Index32> members_;
};

}  // namespace

std::vector<signed char> numbering_signs(Mesh const& mesh, ElementSides const& sides,
                                         std::vector<signed char> const& volume_signs) {
  return Numbering(mesh, sides, volume_signs).run();
}

std::vector<signed char> numbering_signs(HostInstance const& host, Mesh const& mesh, ElementSides const& sides) {
  return numbering_signs(mesh, sides, volume_signs(host, mesh));
}

std::vector<signed char> detail::signs_of(HostInstance const& host, Mesh const& mesh, ElementSides const& sides,
                                          std::vector<signed char> const& known) {
  return Index(known.size()) == mesh.n_elements() ? known : numbering_signs(host, mesh, sides);
}

}  // namespace gridmorph
