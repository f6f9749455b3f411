#include <gridmorph/fillet/joined_elements.hpp>

#include <gridmorph/mesh/undeclared_connections.hpp>

#include <algorithm>

namespace gridmorph {

JoinedElements::JoinedElements(Mesh const& mesh, UnstructuredTopology const& topology)
    : mesh_(mesh), topology_(topology), place_(nodes_at_one_place(mesh)) {
  for (std::size_t n = 0; n < place_.size(); ++n)
    if (place_[n] != Index32(n)) further_[place_[n]].push_back(Index32(n));
}

std::vector<Index32> JoinedElements::nodes_at(Index32 place) const {
  std::vector<Index32> out{place};
  if (auto const found = further_.find(place); found != further_.end())
    out.insert(out.end(), found->second.begin(), found->second.end());
  return out;
}

std::vector<Index32> JoinedElements::around(Index32 place) const {
  std::vector<Index32> out;
  for (Index32 const n : nodes_at(place)) {
    auto const here = topology_.elements_of_nodes[n];
    out.insert(out.end(), here.begin(), here.end());
  }
  return out;
}

std::vector<Index32> JoinedElements::with(std::span<Index32 const> places) const {
  std::vector<Index32> out = around(places.front());
  std::erase_if(out, [&](Index32 e) {
    return !std::all_of(places.begin() + 1, places.end(), [&](Index32 p) { return has(e, p); });
  });
  return out;
}

bool JoinedElements::has(Index32 element, Index32 place) const { return node_at(element, place) >= 0; }

Index32 JoinedElements::node_at(Index32 element, Index32 place) const {
  for (Index32 const n : mesh_.elements.corners(element))
    if (place_[std::size_t(n)] == place) return n;
  return -1;
}

}  // namespace gridmorph
