// Time as the core knows it: an argument, never a clock that can be read.
#pragma once

#include <chrono>
#include <cstdint>

namespace robot {

// A monotonic time line with nanosecond ticks and no now(): only callers outside the core know what time it is.
// Zero is the start of the run (live and simulated) or the logger's zero (replay).
struct RobotClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::duration<rep, period>;
  using time_point = std::chrono::time_point<RobotClock>;
  static constexpr bool is_steady = true;
};

using Time = RobotClock::time_point;
using Seconds = std::chrono::duration<double>;
using namespace std::chrono_literals;

// Seconds since the time line's zero.
constexpr double to_seconds(Time time) { return Seconds(time.time_since_epoch()).count(); }

constexpr Time from_seconds(double seconds) {
  return Time(std::chrono::duration_cast<RobotClock::duration>(Seconds(seconds)));
}

// Moves a time by a (fractional) number of seconds.
constexpr Time operator+(Time time, Seconds step) {
  return time + std::chrono::duration_cast<RobotClock::duration>(step);
}
constexpr Time operator-(Time time, Seconds step) {
  return time - std::chrono::duration_cast<RobotClock::duration>(step);
}

}  // namespace robot
