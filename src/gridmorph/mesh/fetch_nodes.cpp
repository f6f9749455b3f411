#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/fetch_nodes.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

using HomeBox = Distribution::HomeBox;

/// Nodes that share a home: where they are there, and where they go.
struct Fetched {
  HomeBox from;
  Part to;  ///< the whole box, at its place in the result
};

template <class Function>
void for_nodes(IndexRange const& nodes, Function const& f) {
  for (int k = nodes.begin[2]; k < nodes.end[2]; ++k)
    for (int j = nodes.begin[1]; j < nodes.end[1]; ++j)
      for (int i = nodes.begin[0]; i < nodes.end[0]; ++i) f(Index3{i, j, k});
}

/// What is asked of each rank, in the order in which it answers.
std::map<int, std::vector<Fetched>> fetched_by_rank(Distribution const& distribution, std::span<NodeBox const> boxes) {
  std::map<int, std::vector<Fetched>> out;
  Index first = 0;
  for (NodeBox const& box : boxes) {
    for (HomeBox const& from : distribution.homes(box))
      out[distribution.parts()[from.part].rank].push_back({from, {box.zone, box.nodes, -1, first}});
    first += box.nodes.size();
  }
  return out;
}

/// The coordinates that a rank asks for.
Bytes answer(Distribution const& distribution, Coordinates const& own, Bytes const& request) {
  auto const asked = from_bytes<HomeBox>(request);
  std::size_t n = 0;
  for (HomeBox const& from : asked) n += std::size_t(from.nodes.size());
  Bytes out(n * sizeof(Vec3));
  std::byte* next = out.data();
  for (HomeBox const& from : asked)
    for_nodes(from.nodes, [&](Index3 const& p) {
      Vec3 const x = own[distribution.parts()[from.part].node(p)];
      std::memcpy(next, &x, sizeof(Vec3));
      next += sizeof(Vec3);
    });
  return out;
}

/// Puts what a rank answered where it goes.
void take(std::vector<Fetched> const& list, Bytes const& answered, Coordinates& all) {
  std::byte const* next = answered.data();
  for (Fetched const& fetched : list)
    for_nodes(fetched.from.nodes, [&](Index3 const& p) {
      Vec3 x;
      std::memcpy(&x, next, sizeof(Vec3));
      next += sizeof(Vec3);
      all.set(fetched.to.node(p), x);
    });
}

void copy_own(Distribution const& distribution, Coordinates const& own, std::vector<Fetched> const& list,
              Coordinates& all) {
  for (Fetched const& fetched : list)
    for_nodes(fetched.from.nodes, [&](Index3 const& p) {
      all.set(fetched.to.node(p), own[distribution.parts()[fetched.from.part].node(p)]);
    });
}

std::vector<Packet> requests(std::map<int, std::vector<Fetched>> const& by_rank, int own_rank) {
  std::map<int, std::vector<HomeBox>> asked;
  for (auto const& [rank, list] : by_rank)
    for (Fetched const& fetched : list)
      if (rank != own_rank) asked[rank].push_back(fetched.from);
  return to_packets(asked);
}

Index n_nodes(std::span<NodeBox const> boxes) {
  Index n = 0;
  for (NodeBox const& box : boxes) n += box.nodes.size();
  return n;
}

}  // namespace

Coordinates fetch_nodes(Distribution const& distribution, Coordinates const& own, std::span<NodeBox const> boxes) {
  Ranks const& ranks = distribution.ranks();
  auto [by_rank, all] = together(ranks, [&] {
    if (own.size() != distribution.n_nodes())
      throw MeshError("gridmorph::fetch_nodes: the parts of this rank have " + std::to_string(distribution.n_nodes()) +
                      " nodes, and coordinates were given for " + std::to_string(own.size()));
    auto list = fetched_by_rank(distribution, boxes);  // looks at the boxes before their nodes are counted
    return std::pair(std::move(list), Coordinates(n_nodes(boxes)));
  });
  std::vector<Packet> packets = ranks.send(requests(by_rank, ranks.rank()));
  together(ranks, [&] {
    for (Packet& p : packets) p.bytes = answer(distribution, own, p.bytes);
  });
  for (Packet const& p : ranks.send(std::move(packets))) take(by_rank.at(p.rank), p.bytes, all);
  if (auto const here = by_rank.find(ranks.rank()); here != by_rank.end())
    copy_own(distribution, own, here->second, all);
  return all;
}

}  // namespace gridmorph
