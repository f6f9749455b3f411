#include <gridmorph/plan/detail/hash64.hpp>

#include <algorithm>
#include <bit>
#include <cstring>

namespace gridmorph::detail {
namespace {

constexpr std::uint64_t p1 = 0x9E3779B185EBCA87u, p2 = 0xC2B2AE3D27D4EB4Fu, p3 = 0x165667B19E3779F9u,
                        p4 = 0x85EBCA77C2B2AE63u, p5 = 0x27D4EB2F165667C5u;

/// Little-endian, wherever this runs; compilers make one load of it.
template <class Word>
Word load(std::byte const* at) {
  Word w = 0;
  for (std::size_t b = 0; b < sizeof(Word); ++b) w |= Word(at[b]) << (8 * b);
  return w;
}

std::uint64_t round(std::uint64_t lane, std::uint64_t word) { return std::rotl(lane + word * p2, 31) * p1; }

}  // namespace

void Hash64::mix(std::byte const* at) {
  for (std::size_t l = 0; l < lanes_.size(); ++l) lanes_[l] = round(lanes_[l], load<std::uint64_t>(at + 8 * l));
}

void Hash64::add(std::span<std::byte const> bytes) {
  if (bytes.empty()) return;
  n_ += bytes.size();
  if (n_rest_ > 0) {
    std::size_t const taken = std::min(stripe - n_rest_, bytes.size());
    std::memcpy(rest_.data() + n_rest_, bytes.data(), taken);
    n_rest_ += taken;
    bytes = bytes.subspan(taken);
    if (n_rest_ < stripe) return;
    mix(rest_.data());
    n_rest_ = 0;
  }
  for (; bytes.size() >= stripe; bytes = bytes.subspan(stripe)) mix(bytes.data());
  std::copy(bytes.begin(), bytes.end(), rest_.begin());
  n_rest_ = bytes.size();
}

std::uint64_t Hash64::value() const {
  std::uint64_t h = p5;
  if (n_ >= stripe) {
    h = std::rotl(lanes_[0], 1) + std::rotl(lanes_[1], 7) + std::rotl(lanes_[2], 12) + std::rotl(lanes_[3], 18);
    for (std::uint64_t const lane : lanes_) h = (h ^ round(0, lane)) * p1 + p4;
  }
  h += n_;
  std::byte const *at = rest_.data(), *const end = at + n_rest_;
  for (; end - at >= 8; at += 8) h = std::rotl(h ^ round(0, load<std::uint64_t>(at)), 27) * p1 + p4;
  for (; end - at >= 4; at += 4) h = std::rotl(h ^ (load<std::uint32_t>(at) * p1), 23) * p2 + p3;
  for (; at != end; ++at) h = std::rotl(h ^ (std::uint64_t(*at) * p5), 11) * p1;
  h = (h ^ (h >> 33)) * p2;
  h = (h ^ (h >> 29)) * p3;
  return h ^ (h >> 32);
}

}  // namespace gridmorph::detail
