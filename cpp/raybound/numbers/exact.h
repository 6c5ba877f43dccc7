// Signs of determinants without rounding, for the few that floating-point arithmetic cannot tell: a sum of doubles kept
// as parts that do not overlap (Shewchuk 1997).
#pragma once

#include <cmath>

namespace raybound {

// The value is exact as long as no product underflows: coordinates of 2^-60 and more and directions of 2^-120 are far
// from that. `capacity` bounds how many numbers are added.
template <int capacity>
class ExactSum {
  public:
    void add(double x) {
        int kept = 0;
        for (int i = 0; i < count_; ++i) {
            const double sum = x + part_[i], back = sum - x;
            const double lost = (x - (sum - back)) + (part_[i] - back);
            if (lost != 0) part_[kept++] = lost;
            x = sum;
        }
        if (x != 0) part_[kept++] = x;
        count_ = kept;
    }
    void add_product(double a, double b) {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }
    void add_product(double a, double b, double c) {
        const double product = a * b, lost = std::fma(a, b, -product);
        if (lost != 0) add_product(lost, c);
        add_product(product, c);
    }

    // Within an ulp, with the exact sign: the largest part, which is last, outweighs the others.
    double value() const {
        double sum = 0;
        for (int i = 0; i < count_; ++i) sum += part_[i];
        return sum;
    }

  private:
    double part_[capacity];
    int count_ = 0;
};

}  // namespace raybound
