// Damaged input for readers that must survive anything: cut, flipped, joined and random bytes.
#pragma once

#include <rapidcheck.h>

#include <string>
#include <vector>

namespace testing_support {

// A byte string that has been cut, had bytes changed, doubled or replaced by noise, starting from a good one.
inline rc::Gen<std::string> damaged(const std::string& good) {
  return rc::gen::exec([good] {
    std::string bytes = good;
    const int wounds = *rc::gen::inRange(1, 6);
    for (int i = 0; i < wounds && !bytes.empty(); ++i) {
      const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
      switch (*rc::gen::inRange(0, 5)) {
        case 0:
          bytes.resize(at);
          break;
        case 1:
          bytes[at] = static_cast<char>(*rc::gen::inRange(0, 256));
          break;
        case 2:
          bytes.erase(at, *rc::gen::inRange<std::size_t>(1, 40));
          break;
        case 3:
          bytes.insert(at, bytes.substr(bytes.size() / 2, 40));
          break;
        default:
          bytes.insert(at, *rc::gen::container<std::string>(rc::gen::arbitrary<char>()));
          break;
      }
    }
    return bytes;
  });
}

}  // namespace testing_support
