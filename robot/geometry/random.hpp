// The dice of the core: a small seeded generator that gives the same numbers on every run.
// xoshiro256++ (Blackman and Vigna 2019), seeded by splitmix64; normal deviates by Marsaglia's polar method.
#pragma once

#include <cmath>
#include <cstdint>

namespace robot {

class Random {
 public:
  using result_type = std::uint64_t;

  explicit Random(std::uint64_t seed = 1) {
    for (auto& word : state_) {
      seed += 0x9E3779B97F4A7C15ull;
      std::uint64_t z = seed;
      z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
      z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
      word = z ^ (z >> 31);
    }
  }

  // A UniformRandomBitGenerator, so that std::shuffle and friends take it.
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~0ull; }
  result_type operator()() {
    const std::uint64_t result = rotate(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotate(state_[3], 45);
    return result;
  }

  // Uniform in [0, 1).
  double uniform() { return static_cast<double>((*this)() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  // Uniform in {0, .., count - 1}; count > 0.
  std::uint64_t index(std::uint64_t count) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(count));
  }
  // True with the given probability.
  bool chance(double probability) { return uniform() < probability; }

  // Normal with mean 0 and the given standard deviation.
  double normal(double sigma = 1.0) {
    if (has_spare_) {
      has_spare_ = false;
      return sigma * spare_;
    }
    double u, v, s;
    do {
      u = uniform(-1.0, 1.0);
      v = uniform(-1.0, 1.0);
      s = u * u + v * v;
    } while (s >= 1.0 || s == 0.0);
    const double factor = std::sqrt(-2.0 * std::log(s) / s);
    spare_ = v * factor;
    has_spare_ = true;
    return sigma * u * factor;
  }

  // A generator of its own for a module, so that one module's use does not shift another's numbers.
  Random split() { return Random((*this)()); }

 private:
  static std::uint64_t rotate(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }

  std::uint64_t state_[4];
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace robot
