// Long work that somebody waits for.
#pragma once

#include <chrono>
#include <functional>

namespace raybound {

// How the caller looks after long work: called every few milliseconds with the fraction done; may throw, which cancels
// the work and is passed on. None if it is empty.
using Watch = std::function<void(double)>;

// Work on the caller's own thread takes steps of about a microsecond or less, and has the watch called every 20 ms.
class Lookout {
  public:
    Lookout() = default;
    explicit Lookout(const Watch& watch) : watch_(watch ? &watch : nullptr) {}

    void step(int count = 1) {
        steps_ += count;
        if (steps_ >= steps_between) look();
    }

  private:
    static constexpr int steps_between = 1024;  // TUNED: looks at the clock, which take 30 ns
    using Clock = std::chrono::steady_clock;

    void look() {
        steps_ = 0;
        const auto now = Clock::now();
        if (!watch_ || now < next_) return;
        next_ = now + std::chrono::milliseconds(20);
        (*watch_)(0);
    }

    const Watch* watch_ = nullptr;
    int steps_ = 0;
    Clock::time_point next_ = Clock::now() + std::chrono::milliseconds(20);
};

}  // namespace raybound
