// What the links to real (or simulated) devices have in common: they own a serial line, keep it alive, and say what
// happens on it as events. A link belongs to one executor; everything is called and calls back there.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "robot/inputs.hpp"

namespace devices {

using namespace std::chrono_literals;
using Instant = std::chrono::steady_clock::time_point;
using Duration = std::chrono::steady_clock::duration;

// The run's time line, read when bytes arrive.
using Clock = std::function<robot::Time()>;
using EventSink = std::function<void(robot::Event)>;

// How long until the next attempt at a dead line: soon at first, then ever more rarely.
class Backoff {
 public:
  Duration next() { return std::exchange(wait_, std::min<Duration>(2 * wait_, 1s)); }
  void reset() { wait_ = 50ms; }

 private:
  Duration wait_ = 50ms;
};

// Three missed periods; never less than what a busy machine may be late by.
inline Duration silence_limit(std::chrono::duration<double> period) {
  return std::max<Duration>(250ms, std::chrono::duration_cast<Duration>(3.0 * period));
}

// Says when so much of what comes is damaged that the rest should not be trusted either: checksums let one damaged
// frame in some ten thousands pass.
class NoiseGauge {
 public:
  // Counters as they stand now; true at the end of a second in which a third of the frames was damaged.
  bool too_noisy(std::uint64_t frames, std::uint64_t bad_checksums, Instant now) {
    if (now - since_ < 1s) return false;
    const std::uint64_t good = frames - std::exchange(frames_, frames);
    const std::uint64_t bad = bad_checksums - std::exchange(bad_, bad_checksums);
    const bool whole_second = now - std::exchange(since_, now) < 2s;
    return whole_second && bad >= 5 && 2 * bad > good;
  }

 private:
  Instant since_{};
  std::uint64_t frames_ = 0, bad_ = 0;
};

// Rates to try in this order, each once; zeros left out.
inline std::vector<int> rates_to_try(std::initializer_list<int> rates) {
  std::vector<int> out;
  for (const int rate : rates) {
    if (rate != 0 && std::find(out.begin(), out.end(), rate) == out.end()) out.push_back(rate);
  }
  return out;
}

// How long `bytes` take on a line of `baud`, 8N1.
inline std::chrono::duration<double> transmission_time(std::size_t bytes, int baud) {
  return std::chrono::duration<double>(10.0 * static_cast<double>(bytes) / baud);
}

// The health of a line since it was first opened.
struct LineStatistics {
  std::uint64_t frames = 0;
  std::uint64_t bad_checksums = 0;
  std::uint64_t skipped_bytes = 0;
  std::uint64_t connections = 0;  // times that the device came (back)
  std::string identity;           // what the device calls itself
  int baud = 0;
  bool connected = false;
};

}  // namespace devices
