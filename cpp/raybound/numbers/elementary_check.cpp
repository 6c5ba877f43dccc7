#include "raybound/numbers/elementary_check.h"

#include <stdexcept>

#include "raybound/numbers/elementary.h"
#include "raybound/numbers/float_bits.h"

namespace raybound {

namespace {

// The distance of neighbouring floats around a true value, that of subnormals at least.
double ulp_at(double x) {
    int exponent = 0;
    std::frexp(x, &exponent);
    return std::ldexp(1.0, std::max(exponent - 24, -149));
}

double error_in_ulp(float computed, double exact) {
    if (std::isnan(exact)) return std::isnan(computed) ? 0 : infinity<double>;
    if (std::isinf(computed)) return exact >= double(std::numeric_limits<float>::max()) ? 0 : infinity<double>;
    if (std::isinf(exact)) return infinity<double>;
    return std::abs(double(computed) - exact) / ulp_at(exact);
}

template <class Function, class Reference>
ElementaryError sweep(std::uint32_t first, std::uint64_t count, std::uint32_t stride, Function f, Reference reference) {
    ElementaryError worst;
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto bits = static_cast<std::uint32_t>(first + i * stride);
        const float x = std::bit_cast<float>(bits);
        const double error = error_in_ulp(f(x), reference(double(x)));
        worst.tested += !std::isnan(x);
        if (error > worst.ulp) worst.ulp = error, worst.bits = bits;
    }
    return worst;
}

}  // namespace

ElementaryError check_elementary(const std::string& name, std::uint32_t first, std::uint64_t count,
                                 std::uint32_t stride) {
    if (name == "exp")
        return sweep(first, count, stride, [](float x) { return exp(x); }, [](double x) { return std::exp(x); });
    if (name == "acos")
        return sweep(first, count, stride, [](float x) { return acos(x); }, [](double x) { return std::acos(x); });
    if (name == "sqrt")
        return sweep(first, count, stride, [](float x) { return sqrt(x); }, [](double x) { return std::sqrt(x); });
    throw std::invalid_argument("check_elementary: name must be 'exp', 'acos' or 'sqrt', got '" + name + "'");
}

}  // namespace raybound
