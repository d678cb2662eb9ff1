// Pictures to JPEG, once per frame for all viewers (libjpeg-turbo).
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace server {

// `rgb`: rows from the top, 3 bytes a pixel, exactly width * height * 3 of them; quality 1..100. Colour is halved
// (4:2:0). Throws std::invalid_argument on a bad shape, std::runtime_error when the encoder fails.
std::string encode_jpeg(std::span<const std::uint8_t> rgb, int width, int height, int quality = 75);

}  // namespace server
