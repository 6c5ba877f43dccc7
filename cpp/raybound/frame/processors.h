// How many processors this process may keep busy: those that it is bound to, as far as its control group grants them.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace raybound {

// The processors' worth of time that control groups grant, from the text of their files; nothing if that is unlimited
// or the text is none of theirs. Version 2 has cpu.max ("150000 100000" or "max 100000": microseconds of each period),
// version 1 has cpu.cfs_quota_us ("150000", or "-1") and cpu.cfs_period_us.
std::optional<double> granted_by_cpu_max(std::string_view text);
std::optional<double> granted_by_cfs(std::string_view quota, std::string_view period);

// The least that a process is granted by its groups and those above them. `memberships` is the text of
// /proc/self/cgroup, `root` the folder where control groups are mounted. Files that are missing limit nothing.
std::optional<double> granted_by_groups(std::string_view memberships, const std::filesystem::path& root);

// The processors that this thread may run on (sched_getaffinity), at least 1.
int bound_processors();

// What `threads=0` stands for: the processors that the process is bound to, or fewer if less than that is granted; a
// part of a processor counts as one. What is granted is read once for each process.
int usable_processors();

}  // namespace raybound
