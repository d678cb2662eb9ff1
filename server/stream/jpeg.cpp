#include "server/stream/jpeg.hpp"

#include <turbojpeg.h>

#include <memory>
#include <stdexcept>

namespace server {

std::string encode_jpeg(std::span<const std::uint8_t> rgb, int width, int height, int quality) {
  constexpr int longest = 8192;  // pixels
  if (width < 1 || height < 1 || width > longest || height > longest || quality < 1 || quality > 100 ||
      rgb.size() != std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw std::invalid_argument("encode_jpeg: bad size or quality");
  }
  const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), tjDestroy);
  if (!encoder) throw std::runtime_error("encode_jpeg: no encoder");
  std::string out(tjBufSize(width, height, TJSAMP_420), '\0');
  auto* buffer = reinterpret_cast<unsigned char*>(out.data());
  unsigned long size = out.size();
  if (tjCompress2(encoder.get(), rgb.data(), width, 0, height, TJPF_RGB, &buffer, &size, TJSAMP_420, quality,
                  TJFLAG_NOREALLOC | TJFLAG_FASTDCT) != 0) {
    throw std::runtime_error(std::string("encode_jpeg: ") + tjGetErrorStr2(encoder.get()));
  }
  out.resize(size);
  return out;
}

}  // namespace server
