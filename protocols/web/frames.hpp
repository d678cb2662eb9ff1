// Binary messages of /ws, little-endian; the layout is in README.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "robot/outputs.hpp"

namespace protocols::web {

// A scan as the localizer understood it: message 1.
std::string encode_scan(const robot::ScanView& scan);

// The twelve bytes before a camera's JPEG: message 3.
std::string encode_camera_head(std::uint8_t camera, robot::Time time);

}  // namespace protocols::web
