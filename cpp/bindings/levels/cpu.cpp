// The module raybound._cpu: which instruction levels of x86-64 this CPU and its operating system support.
#include <cpuid.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

namespace {

// A bit of ecx, for features that __builtin_cpu_supports does not know in every compiler.
bool has_ecx_bit(unsigned leaf, int bit) {
    unsigned a = 0, b = 0, c = 0, d = 0;
    return __get_cpuid(leaf, &a, &b, &c, &d) != 0 && (c >> bit & 1) != 0;
}

// The levels as the System V ABI for x86-64 lists them, section 3.1.1.
bool supports_v2() {
    return has_ecx_bit(1, 13) /* cx16 */ && has_ecx_bit(0x80000001, 0) /* lahf */ && __builtin_cpu_supports("popcnt") &&
           __builtin_cpu_supports("sse3") && __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.1") &&
           __builtin_cpu_supports("sse4.2");
}

bool supports_v3() {
    return supports_v2() && __builtin_cpu_supports("avx") && __builtin_cpu_supports("avx2") &&
           __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma") &&
           has_ecx_bit(1, 29) /* f16c */ && has_ecx_bit(0x80000001, 5) /* lzcnt */ && has_ecx_bit(1, 22) /* movbe */;
}

bool supports_v4() {
    return supports_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}

std::vector<std::string> supported_levels() {
    __builtin_cpu_init();
    std::vector<std::string> levels;
    if (supports_v4()) levels.emplace_back("x86-64-v4");
    if (supports_v3()) levels.emplace_back("x86-64-v3");
    if (supports_v2()) levels.emplace_back("x86-64-v2");
    return levels;
}

}  // namespace

PYBIND11_MODULE(_cpu, m) {
    m.doc() = "The instruction levels of this CPU.";
    m.def("supported_levels", &supported_levels, "Names as in -march, the best first.");
}
