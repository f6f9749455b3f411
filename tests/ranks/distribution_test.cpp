// Parts of zones: homes of nodes and cells beside a search through all parts.
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/distribution.hpp>

#include "ranks/drawn_parts.hpp"
#include "support/expect_error.hpp"

#include <gtest/gtest.h>

#include <set>

namespace gridmorph::test {
namespace {

/// One of several ranks, as long as it asks the others for nothing that they would say otherwise.
class OneOfMany final : public Ranks {
 public:
  OneOfMany(int rank, int size) : rank_(rank), size_(size) {}
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }
  void largest(std::span<double>) const override {}
  void add(std::span<std::int64_t>) const override { give_up(""); }
  [[nodiscard]] std::vector<Bytes> gather(std::span<std::byte const>) const override { give_up(""); }
  [[noreturn]] void give_up(std::string_view) const override { std::abort(); }

 private:
  std::vector<Packet> deliver(std::vector<Packet>) const override { give_up(""); }
  std::unique_ptr<Channel> connect(std::vector<Message> const&, std::vector<Message> const&) const override {
    give_up("");
  }
  int rank_, size_;
};

Distribution distribute(Mesh const& mesh, std::vector<Part> parts, int n_ranks, int rank = 0) {
  return {std::make_shared<OneOfMany>(rank, n_ranks), mesh, std::move(parts)};
}

bool holds_cell(IndexRange const& nodes, Index3 const& cell) {
  return nodes.contains(cell) && nodes.contains({cell[0] + 1, cell[1] + 1, cell[2] + 1});
}

/// The first part that holds what is asked for, or -1.
template <class Holds>
int first_of(std::vector<Part> const& parts, int zone, Holds const& holds) {
  for (int n = 0; n < int(parts.size()); ++n)
    if (parts[n].zone == zone && holds(parts[n].nodes)) return n;
  return -1;
}

void expect_homes_by_search(Mesh const& mesh, std::vector<Part> const& parts, Distribution const& distribution) {
  auto const number = [&](Part const& part) { return int(&part - distribution.parts().data()); };
  int n_wrong = 0;
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    IndexRange const all{{0, 0, 0}, mesh.zones[z].extent};
    auto const home_of = [&](Index3 const& p) {
      return first_of(parts, z, [&](IndexRange const& nodes) { return nodes.contains(p); });
    };
    for_indices(all, [&](Index3 const& p) { n_wrong += number(distribution.home(z, p)) != home_of(p); });
    for_indices({{0, 0, 0}, {all.end[0] - 1, all.end[1] - 1, all.end[2] - 1}}, [&](Index3 const& cell) {
      int const whole = first_of(parts, z, [&](IndexRange const& nodes) { return holds_cell(nodes, cell); });
      n_wrong += number(distribution.home_of_cell(z, cell)) != (whole >= 0 ? whole : home_of(cell));
    });
  }
  EXPECT_EQ(n_wrong, 0) << "nodes and cells of " << mesh.n_nodes();
}

TEST(Distribution, HasTheHomesThatASearchFinds) {
  Random random(1);
  for (Joint const joint : {Joint::none, Joint::plane, Joint::layers})
    for (int time = 0; time < 12; ++time) {
      Mesh const mesh = drawn_zones(3, 14, random);
      std::vector<Part> const parts = drawn_parts(mesh, 5, joint, random);
      expect_homes_by_search(mesh, parts, distribute(mesh, parts, 5));
    }
}

TEST(Distribution, TakesPartsThatLieAnyhow) {
  Random random(2);
  for (int time = 0; time < 12; ++time) {
    Mesh const mesh = drawn_zones(2, 12, random);
    std::vector<Part> parts;
    for (int n = 0; n < 40; ++n) {
      int const z = random.below(2);
      IndexRange const nodes = drawn_range(mesh.zones[z], random);
      if (nodes.size() > 0) parts.push_back({z, nodes, random.below(3)});
    }
    for (int z = 0; z < 2; ++z) parts.push_back({z, {{0, 0, 0}, mesh.zones[z].extent}, 2});  // what the others leave
    expect_homes_by_search(mesh, parts, distribute(mesh, parts, 3));
  }
}

TEST(Distribution, TakesPartsOfOneCell) {
  Random random(3);
  Mesh const mesh = drawn_zones(2, 7, random);
  std::vector<Part> parts;
  for (int z = 0; z < 2; ++z) {
    Index3 const n = mesh.zones[z].extent;
    for_indices({{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}}, [&](Index3 const& c) {
      parts.push_back({z, {c, {c[0] + 2, c[1] + 2, c[2] + 2}}, random.below(4)});
    });
  }
  random.shuffle(parts);
  Distribution const distribution = distribute(mesh, parts, 4);
  expect_homes_by_search(mesh, parts, distribution);
  std::set<Part const*> counting;
  for (Part const& part : distribution.parts())
    counting.insert(&distribution.home_of_cell(part.zone, part.nodes.begin));
  EXPECT_EQ(counting.size(), parts.size()) << "each cell counts in its own part";
}

TEST(Distribution, NumbersNodesOfOwnPartsOneAfterAnother) {
  Random random(4);
  Mesh const mesh = drawn_zones(3, 10, random);
  std::vector<Part> const parts = drawn_parts(mesh, 4, Joint::layers, random);
  for (int rank = 0; rank < 6; ++rank) {  // the last ones have nothing
    Distribution const distribution = distribute(mesh, parts, 6, rank);
    Index next = 0;
    for (Part const& part : distribution.own()) {
      EXPECT_EQ(part.rank, rank);
      for_indices(part.nodes, [&](Index3 const& p) { EXPECT_EQ(part.node(p), next++); });
    }
    EXPECT_EQ(distribution.n_nodes(), next);
  }
}

TEST(Distribution, DividesBoxesAmongHomes) {
  Random random(5);
  Mesh const mesh = drawn_zones(2, 15, random);
  std::vector<Part> const parts = drawn_parts(mesh, 4, Joint::plane, random);
  Distribution const distribution = distribute(mesh, parts, 4);
  for (int time = 0; time < 100; ++time) {
    NodeBox const box{time % 2, drawn_range(mesh.zones[time % 2], random)};
    std::set<Index3> seen;
    for (auto const& [part, nodes] : distribution.homes(box))
      for_indices(nodes, [&, part = part](Index3 const& p) {
        EXPECT_TRUE(seen.insert(p).second && box.nodes.contains(p));
        EXPECT_EQ(&distribution.home(box.zone, p), &distribution.parts()[part]);
      });
    EXPECT_EQ(Index(seen.size()), box.nodes.size());
  }
}

/// Zones of 2,000^3 nodes cut into 16^3 parts each, with two layers of ghost nodes.
std::vector<Part> large_parts(Mesh const& mesh) {
  std::vector<Part> out;
  for (int z = 0; z < int(mesh.zones.size()); ++z)
    for_indices({{0, 0, 0}, {16, 16, 16}}, [&](Index3 const& p) {
      Part part{z, {}, int(out.size()) % 3};
      for (int a = 0; a < 3; ++a) {
        part.nodes.begin[a] = std::max(0, 125 * p[a] - 2);
        part.nodes.end[a] = std::min(2000, 125 * (p[a] + 1) + 2);
      }
      out.push_back(part);
    });
  return out;
}

TEST(Distribution, CountsBeyondThirtyTwoBits) {
  Mesh mesh;
  for (char const* name : {"A", "B", "C"}) mesh.add_zone(name, {2000, 2000, 2000});
  std::vector<Part> const parts = large_parts(mesh);
  Distribution const distribution = distribute(mesh, parts, 3, 1);
  Index expected = 0;
  for (Part const& part : parts) expected += part.rank == 1 ? part.nodes.size() : 0;
  EXPECT_EQ(distribution.n_nodes(), expected);
  EXPECT_GT(expected, Index(8000000000));
  Part const& last = distribution.own().back();
  EXPECT_EQ(last.node({last.nodes.end[0] - 1, last.nodes.end[1] - 1, last.nodes.end[2] - 1}), expected - 1);

  Random random(6);
  for (int time = 0; time < 200; ++time) {
    Index3 const p{random.below(2000), random.below(2000), random.below(2000)};
    int const z = random.below(3);
    int const n = first_of(parts, z, [&](IndexRange const& nodes) { return nodes.contains(p); });
    EXPECT_EQ(&distribution.home(z, p), &distribution.parts()[n]);
  }
  Index n_nodes = 0;
  for (auto const& piece : distribution.homes({2, {{0, 0, 0}, {2000, 2000, 2000}}})) n_nodes += piece.nodes.size();
  EXPECT_EQ(n_nodes, Index(8000000000));

  Mesh whole;
  whole.add_zone("A", {2000, 2000, 2000});
  EXPECT_EQ(distribute(whole, {{0, {{0, 0, 0}, {2000, 2000, 2000}}, 0}}, 1).n_nodes(), Index(8000000000));
}

TEST(Distribution, TakesZonesWithoutNodes) {
  Mesh mesh;
  mesh.add_zone("nothing", Index3{0, 0, 0});
  mesh.add_zone("A", {2, 3, 4});
  Distribution const distribution = distribute(mesh, {{1, {{0, 0, 0}, {2, 3, 4}}, 0}}, 1);
  EXPECT_EQ(distribution.n_nodes(), 24);
  EXPECT_TRUE(distribution.homes({0, {}}).empty());
  EXPECT_EQ(distribute(Mesh(), {}, 1).n_nodes(), 0);
}

TEST(Distribution, NamesANodeThatIsInNoPart) {
  Mesh mesh;
  mesh.add_zone("first", {4, 4, 4});
  mesh.add_zone("outlet", {5, 6, 7});
  std::vector<Part> const parts{
      {0, {{0, 0, 0}, {4, 4, 4}}, 0}, {1, {{0, 0, 0}, {5, 6, 5}}, 0}, {1, {{0, 0, 5}, {5, 3, 7}}, 0}};
  expect_all_in(message_of<MeshError>([&] { distribute(mesh, parts, 1); }),
                {"zone 'outlet'", "(i 1, j 4, k 6)", "in no part", "[1:5, 4:6, 6:7]"});
}

TEST(Distribution, RefusesPartsThatCannotBe) {
  Mesh mesh;
  mesh.add_zone("A", {4, 4, 4});
  Part const whole{0, {{0, 0, 0}, {4, 4, 4}}, 0};
  auto const words = [&](Part const& part) {
    return message_of<MeshError>([&] { distribute(mesh, {whole, part}, 2); });
  };
  expect_all_in(words({1, whole.nodes, 0}), {"zone number 1", "there are 1"});
  expect_all_in(words({0, whole.nodes, 2}), {"zone 'A'", "rank 2"});
  expect_all_in(words({0, {{0, 0, 0}, {4, 5, 4}}, 1}), {"zone 'A'", "[1:4, 1:5, 1:4]", "4 x 4 x 4"});
  expect_all_in(words({0, {{0, 2, 0}, {4, 2, 4}}, 1}), {"no node", "rank 1"});

  Distribution const distribution = distribute(mesh, {whole}, 2);
  expect_all_in(message_of<MeshError>([&] { (void)distribution.home(0, {0, 4, 0}); }), {"zone 'A'"});
  expect_all_in(message_of<MeshError>([&] { (void)distribution.home_of_cell(0, {0, 3, 0}); }), {"zone 'A'"});
  expect_all_in(message_of<MeshError>([&] { (void)distribution.homes({0, {{-1, 0, 0}, {4, 4, 4}}}); }), {"zone 'A'"});

  expect_all_in(message_of<MeshError>([&] { (void)distribution.homes({2, {}}); }), {"zone number 2", "there are 1"});

  Mesh elements;
  elements.add_zone("fluid", Index(10));
  expect_all_in(message_of<MeshError>([&] { distribute(elements, {}, 1); }), {"zone 'fluid'", "elements"});
}

}  // namespace
}  // namespace gridmorph::test
