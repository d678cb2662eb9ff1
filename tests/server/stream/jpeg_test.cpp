#include "server/stream/jpeg.hpp"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cmath>
#include <vector>

namespace {

TEST(Jpeg, ComesBackAsItWas) {
  constexpr int width = 64, height = 48;
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      rgb.insert(rgb.end(), {static_cast<std::uint8_t>(3 * x), static_cast<std::uint8_t>(4 * y), 128});
  }
  const std::string jpeg = server::encode_jpeg(rgb, width, height, 90);
  const tjhandle decoder = tjInitDecompress();
  std::vector<std::uint8_t> back(rgb.size());
  ASSERT_EQ(tjDecompress2(decoder, reinterpret_cast<const unsigned char*>(jpeg.data()), jpeg.size(), back.data(), width,
                          0, height, TJPF_RGB, 0),
            0);
  tjDestroy(decoder);
  double error = 0.0;
  for (std::size_t i = 0; i < rgb.size(); ++i) error += std::abs(rgb[i] - back[i]);
  EXPECT_LT(error / static_cast<double>(rgb.size()), 3.0);
  EXPECT_LT(server::encode_jpeg(rgb, width, height, 20).size(), jpeg.size());
}

TEST(Jpeg, RefusesBadShapes) {
  const std::vector<std::uint8_t> rgb(12);
  EXPECT_THROW(server::encode_jpeg(rgb, 2, 3), std::invalid_argument);
  EXPECT_THROW(server::encode_jpeg(rgb, -2, -2), std::invalid_argument);
  EXPECT_THROW(server::encode_jpeg(rgb, 2, 2, 0), std::invalid_argument);
  EXPECT_THROW(server::encode_jpeg({}, 0, 0), std::invalid_argument);
  EXPECT_NO_THROW(server::encode_jpeg(rgb, 2, 2));
}

}  // namespace
