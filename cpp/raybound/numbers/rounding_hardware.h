// Directed rounding by instructions that carry their own rounding mode (AVX-512; see rounding.h).
#pragma once

#ifdef __AVX512F__

#include "raybound/numbers/rounding_lanes.h"

namespace raybound {

namespace hardware {

// Numbers and lanes as the registers that can round in a direction: the lowest element, or all of 512 bits. What lies
// beyond the lanes is not looked at; it is 0 unless such a register was used for it before. (Forms with a mask of ones
// are the same instructions, without the undefined operand that g++ warns of.)
inline __m128d load(double x) { return _mm_set1_pd(x); }
inline __m128 load(float x) { return _mm_set1_ps(x); }
inline __m512d load(Lanes<double, 2> x) { return _mm512_castpd128_pd512((__m128d)x); }
inline __m512d load(Lanes<double, 8> x) { return (__m512d)x; }
inline __m512 load(Lanes<float, 2> x) { return _mm512_zextps128_ps512((__m128)Lanes<float, 4>{x[0], x[1], 0, 0}); }
inline __m512 load(Lanes<float, 8> x) {
    return (__m512)_mm512_maskz_insertf64x4(0xff, _mm512_setzero_pd(), (__m256d)x, 0);
}

template <class V, class Register>
inline V value(Register x) {
    if constexpr (std::is_same_v<V, double>)
        return _mm_cvtsd_f64(x);
    else if constexpr (std::is_same_v<V, float>)
        return _mm_cvtss_f32(x);
    else if constexpr (std::is_same_v<V, Lanes<double, 2>>)
        return (V)_mm512_maskz_extractf32x4_ps(0xf, (__m512)x, 0);
    else if constexpr (std::is_same_v<V, Lanes<float, 2>>) {
        const auto four = (Lanes<float, 4>)_mm512_maskz_extractf32x4_ps(0xf, x, 0);
        return V{four[0], four[1]};
    } else if constexpr (std::is_same_v<V, Lanes<float, 8>>)
        return (V)_mm512_maskz_extractf64x4_pd(0xf, (__m512d)x, 0);
    else
        return (V)x;
}

template <int mode>
inline __m128d add(__m128d a, __m128d b) {
    return _mm_add_round_sd(a, b, mode);
}
template <int mode>
inline __m128 add(__m128 a, __m128 b) {
    return _mm_add_round_ss(a, b, mode);
}
template <int mode>
inline __m512d add(__m512d a, __m512d b) {
    return _mm512_maskz_add_round_pd(0xff, a, b, mode);
}
template <int mode>
inline __m512 add(__m512 a, __m512 b) {
    return _mm512_maskz_add_round_ps(0xffff, a, b, mode);
}
template <int mode>
inline __m128d subtract(__m128d a, __m128d b) {
    return _mm_sub_round_sd(a, b, mode);
}
template <int mode>
inline __m128 subtract(__m128 a, __m128 b) {
    return _mm_sub_round_ss(a, b, mode);
}
template <int mode>
inline __m512d subtract(__m512d a, __m512d b) {
    return _mm512_maskz_sub_round_pd(0xff, a, b, mode);
}
template <int mode>
inline __m512 subtract(__m512 a, __m512 b) {
    return _mm512_maskz_sub_round_ps(0xffff, a, b, mode);
}
template <int mode>
inline __m128d multiply(__m128d a, __m128d b) {
    return _mm_mul_round_sd(a, b, mode);
}
template <int mode>
inline __m128 multiply(__m128 a, __m128 b) {
    return _mm_mul_round_ss(a, b, mode);
}
template <int mode>
inline __m512d multiply(__m512d a, __m512d b) {
    return _mm512_maskz_mul_round_pd(0xff, a, b, mode);
}
template <int mode>
inline __m512 multiply(__m512 a, __m512 b) {
    return _mm512_maskz_mul_round_ps(0xffff, a, b, mode);
}
template <int mode>
inline __m128d divide(__m128d a, __m128d b) {
    return _mm_div_round_sd(a, b, mode);
}
template <int mode>
inline __m128 divide(__m128 a, __m128 b) {
    return _mm_div_round_ss(a, b, mode);
}
template <int mode>
inline __m512d divide(__m512d a, __m512d b) {
    return _mm512_maskz_div_round_pd(0xff, a, b, mode);
}
template <int mode>
inline __m512 divide(__m512 a, __m512 b) {
    return _mm512_maskz_div_round_ps(0xffff, a, b, mode);
}
template <int mode>
inline __m128d square_root(__m128d a) {
    return _mm_sqrt_round_sd(a, a, mode);
}
template <int mode>
inline __m128 square_root(__m128 a) {
    return _mm_sqrt_round_ss(a, a, mode);
}
template <int mode>
inline __m512d square_root(__m512d a) {
    return _mm512_maskz_sqrt_round_pd(0xff, a, mode);
}
template <int mode>
inline __m512 square_root(__m512 a) {
    return _mm512_maskz_sqrt_round_ps(0xffff, a, mode);
}
template <int mode>
inline __m128d fused(__m128d a, __m128d b, __m128d c) {
    return _mm_fmadd_round_sd(a, b, c, mode);
}
template <int mode>
inline __m128 fused(__m128 a, __m128 b, __m128 c) {
    return _mm_fmadd_round_ss(a, b, c, mode);
}
template <int mode>
inline __m512d fused(__m512d a, __m512d b, __m512d c) {
    return _mm512_maskz_fmadd_round_pd(0xff, a, b, c, mode);
}
template <int mode>
inline __m512 fused(__m512 a, __m512 b, __m512 c) {
    return _mm512_maskz_fmadd_round_ps(0xffff, a, b, c, mode);
}

}  // namespace hardware

// Of numbers or lanes (rounding_lanes.h), float or double.
struct HardwareRounding {
#ifdef RAYBOUND_SABOTAGE_ROUNDING
    static constexpr int up = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC, down = up;
#else
    static constexpr int up = _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC;
    static constexpr int down = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
#endif

    template <class V>
    static V add_down(V a, V b) {
        return hardware::value<V>(hardware::add<down>(hardware::load(a), hardware::load(b)));
    }
    template <class V>
    static V add_up(V a, V b) {
        return hardware::value<V>(hardware::add<up>(hardware::load(a), hardware::load(b)));
    }
    template <class V>
    static V subtract_down(V a, V b) {
        return hardware::value<V>(hardware::subtract<down>(hardware::load(a), hardware::load(b)));
    }
    template <class V>
    static V subtract_up(V a, V b) {
        return hardware::value<V>(hardware::subtract<up>(hardware::load(a), hardware::load(b)));
    }
    template <class V>
    static V multiply_down(V a, V b) {
        return hardware::value<V>(hardware::multiply<down>(hardware::load(a), hardware::load(b)));
    }
    template <class V>
    static V multiply_up(V a, V b) {
        return hardware::value<V>(hardware::multiply<up>(hardware::load(a), hardware::load(b)));
    }
    template <class V>
    static V divide_down(V a, V b) {
        return hardware::value<V>(hardware::divide<down>(hardware::load(a), hardware::load(b)));
    }
    template <class V>
    static V divide_up(V a, V b) {
        return hardware::value<V>(hardware::divide<up>(hardware::load(a), hardware::load(b)));
    }
    template <class V>
    static V sqrt_down(V a) {
        return hardware::value<V>(hardware::square_root<down>(hardware::load(a)));
    }
    template <class V>
    static V sqrt_up(V a) {
        return hardware::value<V>(hardware::square_root<up>(hardware::load(a)));
    }
    template <class V>
    static V fma_down(V a, V b, V c) {
        return hardware::value<V>(hardware::fused<down>(hardware::load(a), hardware::load(b), hardware::load(c)));
    }
    template <class V>
    static V fma_up(V a, V b, V c) {
        return hardware::value<V>(hardware::fused<up>(hardware::load(a), hardware::load(b), hardware::load(c)));
    }
};

}  // namespace raybound

#endif
