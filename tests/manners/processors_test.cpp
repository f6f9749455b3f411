// Processors of containers: what their control groups allow.
#include "support/temporary_folder.hpp"

#include <gridmorph/core/processors.hpp>

#include <gtest/gtest.h>

#include <filesystem>

namespace gridmorph::test {
namespace {

/// A file system of control groups.
struct Groups {
  TemporaryFolder folder;

  void put(std::string const& path, std::string const& text) const {
    std::filesystem::create_directories((folder / path).parent_path());
    folder.write(path, text);
  }
  [[nodiscard]] std::optional<double> quota(std::string const& membership) const {
    return processor_quota(folder.path("cgroup"), folder.write("membership", membership));
  }
};

TEST(Processors, AreAtLeastOne) { EXPECT_GE(usable_processors(), 1); }

TEST(Processors, HaveNoQuotaWhereNoGroupSetsOne) {
  Groups const groups;
  EXPECT_FALSE(groups.quota("0::/\n"));
  groups.put("cgroup/cpu.max", "max 100000\n");
  EXPECT_FALSE(groups.quota("0::/user.slice\n"));
  groups.put("cgroup/cpu/cpu.cfs_quota_us", "-1\n");
  groups.put("cgroup/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_FALSE(groups.quota("4:cpu,cpuacct:/\n"));
}

TEST(Processors, TakeTheSmallestQuotaOfAGroupAndThoseThatHoldIt) {
  Groups const groups;
  groups.put("cgroup/a/cpu.max", "300000 100000\n");
  groups.put("cgroup/a/b/cpu.max", "max 100000\n");
  groups.put("cgroup/a/b/c/cpu.max", "450000 100000\n");
  EXPECT_EQ(groups.quota("0::/a/b/c\n"), 3.0);
  EXPECT_EQ(groups.quota("1:name=systemd:/\n0::/a/b\n"), 3.0);
  EXPECT_FALSE(groups.quota("0::/other\n"));
  groups.put("cgroup/cpu.max", "150000 100000\n");
  EXPECT_EQ(groups.quota("0::/path/of/the/host\n"), 1.5) << "inside a container the group itself is the root";
}

TEST(Processors, KnowVersionOneToo) {
  Groups const groups;
  groups.put("cgroup/cpu,cpuacct/docker/1/cpu.cfs_quota_us", "250000\n");
  groups.put("cgroup/cpu,cpuacct/docker/1/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(groups.quota("7:memory:/docker/1\n4:cpu,cpuacct:/docker/1\n"), 2.5);
  EXPECT_FALSE(groups.quota("7:cpuset:/docker/1\n"));
}

}  // namespace
}  // namespace gridmorph::test
