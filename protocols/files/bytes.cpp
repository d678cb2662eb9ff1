#include "protocols/files/bytes.hpp"

#include <zlib.h>

#include <array>
#include <fstream>
#include <memory>
#include <system_error>

#include "protocols/files/problem.hpp"

namespace files {
namespace {

std::string megabytes(std::size_t bytes) { return std::to_string((bytes + 1048575) / 1048576) + " MiB"; }

[[noreturn]] void too_big(const std::string& name, std::size_t max_bytes) {
  throw FileError({name, 0, "holds more than " + megabytes(max_bytes), "use a smaller file"});
}

}  // namespace

std::string gunzip(std::string_view packed, std::size_t max_bytes, const std::string& name) {
  z_stream stream{};
  if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) throw FileError({name, 0, "gzip cannot start", ""});
  const std::unique_ptr<z_stream, int (*)(z_stream*)> closer(&stream, inflateEnd);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string out;
  std::array<char, 65536> block;
  while (true) {
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = static_cast<uInt>(block.size());
    const int result = inflate(&stream, Z_NO_FLUSH);
    const std::size_t got = block.size() - stream.avail_out;
    if (out.size() + got > max_bytes) too_big(name, max_bytes);
    out.append(block.data(), got);
    if (result == Z_STREAM_END) {
      if (stream.avail_in == 0) return out;
      if (inflateReset(&stream) != Z_OK) break;  // gzip files may be joined end to end
    } else if (result != Z_OK) {
      break;
    }
  }
  throw FileError({name, 0, "is a cut or damaged gzip file", "fetch it again"});
}

std::string read_bytes(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw FileError({path.string(), 0, "no such file", "check the name"});
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError({path.string(), 0, "cannot be opened", "check its permissions"});
  const auto size = std::filesystem::file_size(path, error);
  if (error || size > max_bytes) too_big(path.string(), max_bytes);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b') return gunzip(bytes, max_bytes, path.string());
  return bytes;
}

void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path beside = path.string() + ".part";
  {
    std::ofstream out(beside, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.flush();
    if (!out)
      throw FileError({path.string(), 0, "cannot be written", "check the folder, its permissions and free space"});
  }
  std::error_code error;
  std::filesystem::rename(beside, path, error);
  if (error) throw FileError({path.string(), 0, "cannot be written: " + error.message(), "check the folder"});
}

}  // namespace files
