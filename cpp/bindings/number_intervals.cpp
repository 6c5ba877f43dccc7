#include "bindings/number_kinds.h"
#include "raybound/numbers/interval.h"
#include "raybound/numbers/interval_functions.h"

namespace raybound::python {

template <class T, Arithmetic A>
struct Record<Interval<T, A>> {
    using Value = T;
    static constexpr int width = 2;
    static Interval<T, A> load(const T* p) { return {p[0], p[1]}; }
    static void store(const Interval<T, A>& x, T* p) {
        p[0] = x.inf();
        p[1] = x.sup();
    }
};

void register_interval_kinds() {
    register_kind<Interval<double>>("interval_float64");
    register_kind<Interval<float>>("interval_float32");
    register_kind<Interval<double, Arithmetic::float32>>("interval_float64_executed");
    register_kind<Interval<float, Arithmetic::float32>>("interval_float32_executed");
}

}  // namespace raybound::python
