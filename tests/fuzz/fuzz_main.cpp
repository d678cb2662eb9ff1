// Runs a fuzz target without libFuzzer, so that it cannot rot: files given as arguments, or a fixed number of inputs
// made by cutting, joining and flipping the target's own seeds. The same every time.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "robot/geometry/random.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
std::vector<std::vector<std::uint8_t>> fuzz_seeds();

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    std::ifstream file(argv[i], std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  if (argc > 1) return 0;
  constexpr int inputs = 20'000;
  const auto seeds = fuzz_seeds();
  robot::Random random(1998);
  for (int i = 0; i < inputs; ++i) {
    std::vector<std::uint8_t> bytes;
    for (std::uint64_t part = 0, parts = 1 + random.index(6); part < parts; ++part) {
      const auto& seed = seeds[random.index(seeds.size())];
      const auto begin = random.chance(0.7) ? 0 : random.index(seed.size());
      const auto end = random.chance(0.7) ? seed.size() : begin + random.index(seed.size() - begin + 1);
      bytes.insert(bytes.end(), seed.begin() + static_cast<std::ptrdiff_t>(begin),
                   seed.begin() + static_cast<std::ptrdiff_t>(end));
      for (std::uint64_t noise = random.chance(0.3) ? random.index(20) : 0; noise > 0; --noise) {
        bytes.push_back(static_cast<std::uint8_t>(random()));
      }
    }
    if (!bytes.empty() && random.chance(0.5))
      bytes[random.index(bytes.size())] ^= static_cast<std::uint8_t>(1u << random.index(8));
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%d inputs\n", inputs);
  return 0;
}
