#include <thread>

#include "bindings/arrays.h"
#include "raybound/frame/processors.h"

namespace raybound::python {

namespace {

py::dict build_info() {
    return py::dict("version"_a = RAYBOUND_VERSION, "compiler"_a = __VERSION__, "flags"_a = RAYBOUND_FLAGS,
                    "instruction_level"_a = RAYBOUND_ARCH_NAME, "sabotage"_a = RAYBOUND_SABOTAGE_NAME,
                    "sanitizer"_a = RAYBOUND_SANITIZE_NAME, "hardware_threads"_a = std::thread::hardware_concurrency(),
                    "usable_threads"_a = usable_processors());
}

}  // namespace

// RAYBOUND_MODULE is _core, or the name of one instruction level's build: _core_v3. All are known as _core.
PYBIND11_MODULE(RAYBOUND_MODULE, m) {
    m.attr("__name__") = "raybound._core";
    m.doc() = "The raw engine of raybound; the public interface is the package raybound.";
    register_numbers(m);
    register_number_kinds(m);
    register_cells(m);
    register_running_errors(m);
    register_elementary_ranges(m);
    register_intervals(m);
    register_number_bench(m);
    register_transforms(m);
    register_shapes(m);
    register_materials(m);
    register_scene(m);
    register_camera(m);
    register_surface_cells(m);
    register_render(m);
    register_packs(m);
    m.def("build_info", &build_info, "How this module was built.");
    m.def(
        "granted_processors",
        [](const std::string& memberships, const std::string& root) { return granted_by_groups(memberships, root); },
        "memberships"_a, "root"_a, "What control groups grant, in processors: from the text of /proc/self/cgroup.");
}

}  // namespace raybound::python
