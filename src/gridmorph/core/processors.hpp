// How many processors this process may use at once.
#pragma once

#include <filesystem>
#include <optional>

namespace gridmorph {

/// Processors of the affinity mask, no more than the quota of the control groups (containers) lets run at once; at
/// least 1. OpenMP counts the mask alone, and threads beyond the quota are stopped in the midst of their work.
int usable_processors();

/// The smallest quota of the control groups that a process is in, in processors: of version 2 (cpu.max) or 1
/// (cpu.cfs_quota_us); nothing where none is set. `groups`: where they are mounted, usually /sys/fs/cgroup;
/// `membership`: usually /proc/self/cgroup.
std::optional<double> processor_quota(std::filesystem::path const& groups, std::filesystem::path const& membership);

}  // namespace gridmorph
