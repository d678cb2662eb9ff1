// How often somebody may do something: a bucket of tokens that fills at a steady rate. Time is an argument.
#pragma once

#include <algorithm>
#include <chrono>

namespace server {

struct Rate {
  double burst = 20.0;      // tokens at most
  double per_second = 2.0;  // refill
};

class TokenBucket {
 public:
  using Time = std::chrono::steady_clock::time_point;

  TokenBucket(Rate rate, Time now) : rate_(rate), tokens_(rate.burst), filled_(now) {}

  // Takes a token, if there is one.
  bool take(Time now) {
    tokens_ = tokens(now);
    filled_ = now;
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }

  // Whole seconds until there is a token again, at least 1.
  int wait_seconds(Time now) const {
    return std::max(1, static_cast<int>((1.0 - tokens(now)) / rate_.per_second + 0.999));
  }

  // Nothing is remembered of it: it may be forgotten.
  bool full(Time now) const { return tokens(now) >= rate_.burst; }

 private:
  double tokens(Time now) const {
    const double seconds = std::chrono::duration<double>(now - filled_).count();
    return std::min(rate_.burst, tokens_ + std::max(0.0, seconds) * rate_.per_second);
  }

  Rate rate_;
  double tokens_;
  Time filled_;
};

}  // namespace server
