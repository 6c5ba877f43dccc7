#include "bindings/number_kinds.h"

namespace raybound::python {

std::map<std::string, NumberKind>& number_kinds() {
    static std::map<std::string, NumberKind> kinds;
    return kinds;
}

void register_float_kinds() {
    register_kind<float>("float32");
    register_kind<double>("float64");
}

namespace {

const NumberKind& kind_named(const std::string& name) {
    const auto found = number_kinds().find(name);
    if (found == number_kinds().end()) throw std::invalid_argument("number kind: unknown, got '" + name + "'");
    return found->second;
}

py::array apply(const std::string& kind, const std::string& operation, const std::vector<py::array>& operands,
                double parameter) {
    const auto& known = kind_named(kind).operations;
    const auto found = known.find(operation);
    if (found == known.end()) throw std::invalid_argument(kind + ": no operation is called '" + operation + "'");
    return found->second(operands, parameter);
}

py::dict kinds() {
    py::dict all;
    for (const auto& [name, kind] : number_kinds()) {
        py::list operations;
        for (const auto& [operation, f] : kind.operations) operations.append(operation);
        all[py::str(name)] = py::make_tuple(kind.width, operations);
    }
    return all;
}

}  // namespace

void register_number_kinds(py::module_& m) {
    register_float_kinds();
    register_interval_kinds(m);
    register_running_error_kinds();
    register_linear_kinds();
    register_taylor_kinds(m);
    m.def("number_kinds", &kinds, "Each kind of number: the width of its records and its operations.");
    m.def("apply", &apply, "kind"_a, "operation"_a, "operands"_a, "parameter"_a = 0.0,
          "An operation on records of one kind, given as contiguous arrays (..., width); gives (n, width).");
}

}  // namespace raybound::python
