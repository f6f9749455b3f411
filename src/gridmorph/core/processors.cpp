#include <gridmorph/core/processors.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>

#ifdef __linux__
#include <sched.h>
#endif

namespace gridmorph {

namespace {

using Path = std::filesystem::path;

/// Version 2: "max 100000" or "150000 100000", microseconds of processor time per period.
std::optional<double> quota_2(Path const& folder) {
  std::ifstream in(folder / "cpu.max");
  double quota = 0, period = 0;
  if (in >> quota >> period && quota > 0 && period > 0) return quota / period;
  return std::nullopt;
}

/// Version 1: -1 where there is none.
std::optional<double> quota_1(Path const& folder) {
  std::ifstream in_quota(folder / "cpu.cfs_quota_us"), in_period(folder / "cpu.cfs_period_us");
  double quota = 0, period = 0;
  if (in_quota >> quota && in_period >> period && quota > 0 && period > 0) return quota / period;
  return std::nullopt;
}

}  // namespace

std::optional<double> processor_quota(Path const& groups, Path const& membership) {
  std::optional<double> least;
  // Of a group and all that hold it. Inside a container the path is that of the host; the group itself is mounted at
  // the root.
  auto const look = [&](Path const& root, std::string const& group, auto const& quota) {
    Path folder = root / Path(group).relative_path();
    for (;; folder = folder.parent_path()) {
      if (auto const q = quota(folder)) least = std::min(least.value_or(*q), *q);
      if (folder == root || folder == folder.parent_path()) break;
    }
    if (auto const q = quota(root)) least = std::min(least.value_or(*q), *q);
  };
  std::ifstream in(membership);
  for (std::string line; std::getline(in, line);) {  // "0::/user.slice" or "4:cpu,cpuacct:/docker/ab12"
    auto const first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    std::string const controllers = line.substr(first + 1, second - first - 1), group = line.substr(second + 1);
    if (controllers.empty())
      look(groups, group, quota_2);
    else if (("," + controllers + ",").find(",cpu,") != std::string::npos)
      for (auto const& name : {std::string("cpu"), controllers}) look(groups / name, group, quota_1);
  }
  return least;
}

int usable_processors() {
  int count = int(std::max(1U, std::thread::hardware_concurrency()));
#ifdef __linux__
  cpu_set_t set;
  CPU_ZERO(&set);
  // The call fails where there are more processors than the set has room for; then the count above stands.
  if (sched_getaffinity(0, sizeof set, &set) == 0) count = std::max(1, CPU_COUNT(&set));
#endif
  if (auto const quota = processor_quota("/sys/fs/cgroup", "/proc/self/cgroup"))
    count = std::min(count, std::max(1, int(std::ceil(*quota - 1e-9))));
  return count;
}

}  // namespace gridmorph
