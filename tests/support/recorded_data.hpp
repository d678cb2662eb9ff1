// Where recordings of real robots lie, when this machine has them: DOCENT_DATA, else beside the checkout.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace testing_support {

inline std::filesystem::path recorded_data(const std::string& file) {
  const char* folder = std::getenv("DOCENT_DATA");
  return std::filesystem::path(folder ? folder : "../shared/data") / file;
}

}  // namespace testing_support

// Ends the test as skipped, saying which recording is missing.
#define NEED_RECORDING(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs the recording " << (path) << "; set DOCENT_DATA"
