#include "raybound/frame/processors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#ifdef __linux__
#include <sched.h>
#endif

namespace raybound {

namespace {

namespace fs = std::filesystem;

// The text up to a separator, which is taken off with it.
std::string_view take_until(std::string_view& text, char separator) {
    const std::size_t end = text.find(separator);
    const std::string_view taken = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    return taken;
}

std::optional<double> positive_number(std::string_view text) {
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string_view rest(end, std::size_t(text.data() + text.size() - end));
    if (error != std::errc{} || rest.find_first_not_of(" \n") != std::string_view::npos || value <= 0) return {};
    return double(value);
}

std::string text_of(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::optional<double> granted_in_folder(const fs::path& folder) {
    if (const auto granted = granted_by_cpu_max(text_of(folder / "cpu.max"))) return granted;
    return granted_by_cfs(text_of(folder / "cpu.cfs_quota_us"), text_of(folder / "cpu.cfs_period_us"));
}

// The least of a group and those above it. (In a container the group's own path may be that of the host, which is not
// there: then the root speaks for it.)
void grant_least(const fs::path& root, const fs::path& group, std::optional<double>& least) {
    fs::path folder = root;
    const auto look = [&] {
        const auto granted = granted_in_folder(folder);
        if (granted && !(least && *least <= *granted)) least = granted;
    };
    look();
    for (const fs::path& name : group.relative_path()) {
        folder /= name;
        look();
    }
}

bool names_cpu(std::string_view controllers) {
    while (!controllers.empty())
        if (take_until(controllers, ',') == "cpu") return true;
    return false;
}

}  // namespace

std::optional<double> granted_by_cpu_max(std::string_view text) {
    const std::string_view quota = take_until(text, ' ');
    return granted_by_cfs(quota, text);
}

std::optional<double> granted_by_cfs(std::string_view quota, std::string_view period) {
    const auto part = positive_number(quota), whole = positive_number(period);
    if (!part || !whole) return {};
    return *part / *whole;
}

// A line is "hierarchy:controllers:/path"; that of version 2 is "0::/path". Version 1 is mounted by its controllers.
std::optional<double> granted_by_groups(std::string_view memberships, const fs::path& root) {
    std::optional<double> least;
    while (!memberships.empty()) {
        std::string_view path = take_until(memberships, '\n');
        const std::string_view number = take_until(path, ':'), controllers = take_until(path, ':');
        if (number == "0" && controllers.empty()) {
            grant_least(root, path, least);
            grant_least(root / "unified", path, least);
        } else if (names_cpu(controllers)) {
            grant_least(root / "cpu", path, least);
            grant_least(root / controllers, path, least);
        }
    }
    return least;
}

int bound_processors() {
#ifdef __linux__
    // The kernel refuses a set that is smaller than its own.
    for (int size = 1024; size <= 1 << 20; size *= 2) {
        cpu_set_t* set = CPU_ALLOC(size);
        if (set == nullptr) break;
        const std::size_t bytes = CPU_ALLOC_SIZE(size);
        const int count = sched_getaffinity(0, bytes, set) == 0 ? CPU_COUNT_S(bytes, set) : 0;
        CPU_FREE(set);
        if (count > 0) return count;
    }
#endif
    return std::max(1, int(std::thread::hardware_concurrency()));
}

int usable_processors() {
    static const std::optional<double> granted = granted_by_groups(text_of("/proc/self/cgroup"), "/sys/fs/cgroup");
    const int bound = bound_processors();
    return granted && *granted < bound ? int(std::ceil(*granted)) : bound;
}

}  // namespace raybound
