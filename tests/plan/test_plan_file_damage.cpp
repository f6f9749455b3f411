// Plan files that are not what they should be, and places where none can be written.
#include "support/expect_error.hpp"
#include "support/file_size_limit.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/reduced.hpp"
#include "support/temporary_folder.hpp"

#include <gridmorph/plan/detail/hash64.hpp>
#include <gridmorph/plan/detail/reach.hpp>
#include <gridmorph/plan/plan_file.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>

namespace gridmorph::test {
namespace {

std::uint64_t hash_of(std::string_view text) { return detail::hash64(std::as_bytes(std::span(text))); }

/// Values of the reference implementation (xxhsum -H64).
TEST(Hash64, IsXxh64) {
  EXPECT_EQ(hash_of(""), 0xEF46DB3751D8E999u);
  EXPECT_EQ(hash_of("a"), 0xD24EC4F1A98C6E5Bu);
  EXPECT_EQ(hash_of("abc"), 0x44BC2CF5AD770999u);
  EXPECT_EQ(hash_of("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1u);
}

TEST(Hash64, DependsOnTheBytesAndNotOnTheirParts) {
  std::string text;
  for (int n = 0; n < 200; ++n) text += char(n * 7);
  for (std::size_t cut = 0; cut <= text.size(); cut += 3) {
    detail::Hash64 hash;
    hash.add(std::as_bytes(std::span(text).first(cut)));
    hash.add(std::as_bytes(std::span(text).subspan(cut)));
    EXPECT_EQ(hash.value(), hash_of(text)) << cut;
  }
}

TEST(Reach, IsWithinNothingWhereIndicesOverflow) {
  using detail::Reach;
  constexpr Index most = std::numeric_limits<Index>::max(), least = std::numeric_limits<Index>::min();
  EXPECT_TRUE(Reach(5).along(-1, 6).within(0, 6));
  EXPECT_FALSE(Reach(5).along(-1, 7).within(0, 6));
  EXPECT_FALSE(Reach(5).along(1, 2).within(0, 6));
  EXPECT_TRUE(Reach(-3).along(1, 3, 8).within(0, 6));
  for (Index const huge : {most, least, most / 2, least / 2}) {
    EXPECT_FALSE(Reach(huge).within(least, most));
    EXPECT_FALSE(Reach(0).along(huge, 3).within(least, most));
    EXPECT_FALSE(Reach(0).along(huge / 3, 3).along(huge / 3, 3).along(huge / 3, 3).within(least, most));
  }
  EXPECT_TRUE(Reach(0).along(most, 1).within(0, 1));
}

/// A mesh, its plan in a file, and the bytes of the file.
struct Kept {
  TemporaryFolder folder;
  Mesh mesh;
  PlanKey key;
  std::vector<Vec3> boundary;
  std::string bytes;

  Kept(Mesh m, Motion const& motion, PlanOptions const& options = {})
      : mesh(std::move(m)), key(plan_key(mesh, motion, options)) {
    PreparedMorph const prepared = prepare(mesh, motion, options);
    boundary = prepared.boundary_displacement(mesh);
    save_plan(path(), prepared.plan(), key);
    bytes = bytes_of(path());
  }
  [[nodiscard]] std::filesystem::path path() const { return folder / "plan"; }
  Plan load(std::string const& changed) const {
    write_bytes(path(), changed);
    return load_plan(path(), key);
  }
};

Kept small() {
  return {box({3, 3, 3}, Shape::curved, 1),
          motion({rule({"u_min"}, function_rule(waves(0.1))), rule({"u_max"}, FixedRule{}),
                  rule({"v_min", "v_max", "w_min", "w_max"}, FreeRule{})})};
}

/// Stages, corrections, rotations, slip surfaces and their spread.
Kept large(SlipRule const& walls = {SlipRule::Surface::revolution}) {
  Sector const shape;
  Motion m =
      motion({rule({"inlet", "outlet"}, function_rule(turning_waves(shape, 0.05))), rule({"hub", "case"}, walls)});
  m.axis = {shape.origin, shape.axis};
  PlanOptions options;
  options.boundary_layers = {{{"inlet"}, BoundaryLayer::Extent::layers, 1, 0, BoundaryLayer::Mode::translate}};
  return {annulus_sector(shape, 1), m, options};
}

/// A near field around a wall with blocks all round: several stages, known sides.
Kept branched() {
  PlanOptions options;
  options.boundary_layers = {{{"step"}, BoundaryLayer::Extent::layers, 1, 0, BoundaryLayer::Mode::translate}};
  return {around_a_box(7),
          motion({rule({"step"}, function_rule(waves(0.05))), rule({"u_min", "u_max", "v_min", "v_max"}, FixedRule{}),
                  rule({"w_min", "w_max"}, FreeRule{})}),
          options};
}

TEST(DamagedPlanFile, IsReportedWhereverItEnds) {
  Kept const kept = small();
  for (std::size_t n = 0; n < kept.bytes.size(); ++n) {
    std::string const cut(kept.bytes.begin(), kept.bytes.begin() + std::ptrdiff_t(n));
    EXPECT_THROW(kept.load(cut), IoError) << n << " of " << kept.bytes.size() << " bytes";
  }
  std::string more = kept.bytes;
  more.push_back(0);
  EXPECT_THROW(kept.load(more), IoError);
}

TEST(DamagedPlanFile, IsReportedWhicheverByteIsWrong) {
  Kept const kept = small();
  std::mt19937 random(3);
  for (std::size_t n = 0; n < kept.bytes.size(); ++n) {
    std::string bytes = kept.bytes;
    bytes[n] = char(bytes[n] ^ char(1u << random() % 8));
    EXPECT_THROW(kept.load(bytes), Error) << "byte " << n;
  }
}

TEST(DamagedPlanFile, SaysWhatIsWrongAndWhatToDo) {
  Kept const kept = small();
  auto const message = [&](std::string const& bytes) { return message_of<Error>([&] { kept.load(bytes); }); };
  std::string bytes = kept.bytes;
  bytes[bytes.size() / 2] = char(~bytes[bytes.size() / 2]);
  expect_all_in(message(bytes), {kept.path().string(), "damaged", "checksum", "plan again"});
  bytes = kept.bytes;
  bytes[0] = 'x';
  expect_all_in(message(bytes), {"not a gridmorph plan"});
  bytes = kept.bytes;
  bytes[8] = 77;
  expect_all_in(message(bytes), {"format 77", std::to_string(plan_format_version), "plan again"});
  std::filesystem::remove(kept.path());
  expect_all_in(message_of<IoError>([&] { load_plan(kept.path(), kept.key); }), {"no such file"});
  expect_all_in(message_of<IoError>([&] { load_plan(kept.folder / "", kept.key); }), {"not a file"});
}

void repair_checksum(std::string& bytes) {
  std::size_t const end = bytes.size() - sizeof(std::uint64_t);
  std::uint64_t const hash = detail::hash64(std::as_bytes(std::span(bytes).first(end)));
  for (std::size_t b = 0; b < sizeof hash; ++b) bytes[end + b] = char(hash >> (8 * b));
}

/// What the checksum would have caught is put past it: numbers all over the file that are wrong, and a checksum that is
/// right. What loads nevertheless must be safe to run (the sanitizers watch), whatever it computes.
void run_with_wrong_numbers(Kept const& kept, unsigned seed, int trials) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  using Memory = Exec::memory_space;
  Exec const exec;
  DeviceField<Memory> const x(kept.mesh.coordinates), out(Coordinates(kept.mesh.n_nodes()));
  constexpr std::size_t tables = 8 + 4 + 4 * 8 + 8;
  std::mt19937_64 random(seed);
  constexpr std::array<std::int64_t, 13> values{0,
                                                -1,
                                                1,
                                                2,
                                                3,
                                                1000,
                                                -1000,
                                                1 << 20,
                                                1u << 31,
                                                0x7fffffff,
                                                Index(1) << 61,
                                                std::numeric_limits<Index>::max(),
                                                std::numeric_limits<Index>::min()};
  int refused = 0, loaded = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::string bytes = kept.bytes;
    std::size_t const size = random() % 2 == 0 ? 4 : 8;
    std::size_t const at = tables + random() % (bytes.size() - tables - 16);
    std::uint64_t const old = [&] {
      std::uint64_t v = 0;
      std::memcpy(&v, bytes.data() + at, size);
      return v;
    }();
    std::uint64_t const value =
        random() % 3 == 0 ? old + random() % 3 - 1 : std::uint64_t(values[random() % values.size()]);
    std::memcpy(bytes.data() + at, &value, size);
    repair_checksum(bytes);
    try {
      Plan const plan = kept.load(bytes);
      ++loaded;
      std::vector<Vec3> boundary = kept.boundary;
      boundary.resize(plan.boundary_nodes.size());
      Morpher<Exec> const morpher(exec, plan, x.read(), {1, true});
      auto const given = upload<Memory>(boundary);
      morpher.apply(exec, given, x.read(), out.write());
      morpher.velocity(exec, given, given, out.write());
      exec.fence();
      EXPECT_FALSE(describe(plan).empty());
    } catch (IoError const& e) {
      ++refused;
      expect_all_in(e.what(), {"damaged", "plan again"});
    }
  }
  EXPECT_GT(refused, trials / 20);
  EXPECT_GT(loaded, trials / 20);
}

TEST(WrongNumbersInAPlanFile, DoNotReachTheKernelsOfASlidingSector) {
  run_with_wrong_numbers(large(), 1, reduced() ? 1500 : 3000);
}
TEST(WrongNumbersInAPlanFile, DoNotReachTheKernelsOfNodesOnFacets) {
  run_with_wrong_numbers(large({SlipRule::Surface::baseline}), 4, reduced() ? 1500 : 3000);
}
TEST(WrongNumbersInAPlanFile, DoNotReachTheKernelsOfABranchedMesh) {
  run_with_wrong_numbers(branched(), 2, reduced() ? 1500 : 3000);
}
TEST(WrongNumbersInAPlanFile, DoNotReachTheKernelsOfASmallBox) {
  run_with_wrong_numbers(small(), 3, reduced() ? 3000 : 10000);
}

TEST(PlanFile, ThatDoesNotFitOnTheDiskLeavesWhatWasThere) {
  Kept const kept = small();
  Plan const plan = load_plan(kept.path(), kept.key);
  std::string message;
  {
    FileSizeLimit const full(1000);
    message = message_of<MachineError>([&] { save_plan(kept.path(), plan, kept.key); });
    EXPECT_THROW(save_plan(kept.folder / "other", plan, kept.key), MachineError);
  }
  expect_all_in(message, {kept.path().string(), "cannot be written"});
  EXPECT_EQ(kept.folder.names(), std::vector<std::string>{"plan"});
  EXPECT_EQ(bytes_of(kept.path()), kept.bytes);
}

TEST(PlanFile, CannotBeWrittenWhereThereIsNoPlaceForIt) {
  Kept const kept = small();
  Plan const plan = load_plan(kept.path(), kept.key);
  EXPECT_THROW(save_plan(kept.folder / "missing/plan", plan, kept.key), IoError);
  EXPECT_THROW(save_plan(kept.folder / ".", plan, kept.key), IoError);
  EXPECT_THROW(save_plan(kept.path() / "below a file", plan, kept.key), IoError);
  if (std::filesystem::exists("/proc/self")) {  // nobody may make files there
    EXPECT_THROW(save_plan("/proc/gridmorph_plan", plan, kept.key), MachineError);
  }
  EXPECT_EQ(kept.folder.names(), std::vector<std::string>{"plan"});
}

TEST(PlanFile, ReplacesAnOlderOneAndFollowsALink) {
  Kept const kept = small();
  Plan const plan = load_plan(kept.path(), kept.key);
  std::filesystem::create_symlink(kept.path(), kept.folder / "link");
  write_bytes(kept.path(), "old");
  save_plan(kept.folder / "link", plan, kept.key);
  EXPECT_TRUE(std::filesystem::is_symlink(kept.folder / "link"));
  EXPECT_EQ(bytes_of(kept.path()), kept.bytes);
  EXPECT_EQ(kept.folder.names().size(), 2U);
}

}  // namespace
}  // namespace gridmorph::test
