#include "server/http/files.hpp"

#include <brotli/encode.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace server {
namespace {

namespace fs = std::filesystem;

struct Type {
  std::string_view extension;
  const char* content_type;
  bool compressible;
};
constexpr std::array<Type, 19> types{{
    {".html", "text/html; charset=utf-8", true},
    {".js", "text/javascript; charset=utf-8", true},
    {".css", "text/css; charset=utf-8", true},
    {".json", "application/json", true},
    {".webmanifest", "application/manifest+json", true},
    {".map", "application/json", true},
    {".svg", "image/svg+xml", true},
    {".txt", "text/plain; charset=utf-8", true},
    {".png", "image/png", false},
    {".jpg", "image/jpeg", false},
    {".jpeg", "image/jpeg", false},
    {".webp", "image/webp", false},
    {".avif", "image/avif", false},
    {".ico", "image/x-icon", false},
    {".woff2", "font/woff2", false},
    {".mp3", "audio/mpeg", false},
    {".ogg", "audio/ogg", false},
    {".opus", "audio/ogg", false},
    {".wav", "audio/wav", false},
}};

const Type* type_of(const fs::path& file) {
  const std::string extension = file.extension().string();
  const auto it =
      std::find_if(types.begin(), types.end(), [&](const Type& type) { return type.extension == extension; });
  return it == types.end() ? nullptr : &*it;
}

// esbuild's names end in '-' and eight characters of base 32 before the extension.
bool carries_hash(const fs::path& file) {
  const std::string stem = file.stem().string();
  if (stem.size() < 9 || stem[stem.size() - 9] != '-') return false;
  return std::all_of(stem.end() - 8, stem.end(),
                     [](unsigned char c) { return std::isupper(c) || (c >= '2' && c <= '7'); });
}

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return text;
}

std::shared_ptr<const std::string> if_smaller(std::string packed, const std::string& plain) {
  if (packed.empty() || packed.size() + 64 > plain.size()) return nullptr;
  return std::make_shared<const std::string>(std::move(packed));
}

}  // namespace

std::string gzip(std::string_view text) {
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY) != Z_OK) return {};
  std::string out(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const bool done = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  out.resize(done ? stream.total_out : 0);
  deflateEnd(&stream);
  return out;
}

std::string brotli(std::string_view text) {
  constexpr int quality = 9;  // 11 would take ten times as long at every start, for a few per cent
  std::size_t size = BrotliEncoderMaxCompressedSize(text.size());
  std::string out(size, '\0');
  if (!BrotliEncoderCompress(quality, BROTLI_DEFAULT_WINDOW, BROTLI_MODE_TEXT, text.size(),
                             reinterpret_cast<const std::uint8_t*>(text.data()), &size,
                             reinterpret_cast<std::uint8_t*>(out.data()))) {
    return {};
  }
  out.resize(size);
  return out;
}

std::string etag_of(std::string_view content) {
  std::uint64_t hash = 0xCBF29CE484222325ull;  // FNV-1a
  for (const char c : content) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
  constexpr const char* digits = "0123456789abcdef";
  std::string tag;
  for (int shift = 60; shift >= 0; shift -= 4) tag.push_back(digits[hash >> shift & 15]);
  return tag + "-" + std::to_string(content.size());
}

bool takes_encoding(std::string_view accept_encoding, std::string_view coding) {
  for (std::string_view rest = accept_encoding; !rest.empty();) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    std::string_view entry = rest.substr(0, end);
    while (!entry.empty() && entry.front() == ' ') entry.remove_prefix(1);
    std::string_view name = entry.substr(0, entry.find(';'));
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    if (name == coding) {
      const std::size_t q = entry.find("q=");
      return q == std::string_view::npos || entry.substr(q + 2).find_first_not_of("0. ") != std::string_view::npos;
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

bool matches_etag(std::string_view if_none_match, std::string_view etag) {
  if (if_none_match == "*") return true;
  // Quotes stand round the tag, so that no longer tag can hold it.
  return if_none_match.find(etag) != std::string_view::npos;
}

Files::Files(const std::string& folder, FilesLimits limits) {
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) throw std::runtime_error("cannot read the folder " + folder + ": " + error.message());
  std::size_t total = 0;
  for (fs::recursive_directory_iterator it(root), end; it != end; ++it) {
    const fs::path& path = it->path();
    if (path.filename().string().starts_with('.')) {
      if (it->is_directory()) it.disable_recursion_pending();
      continue;
    }
    const Type* type = type_of(path);
    if (!it->is_regular_file() || it->is_symlink() || !type) continue;
    const std::string_view content(type->content_type);
    if (limits.media_only && !content.starts_with("image/") && !content.starts_with("audio/")) continue;
    const std::size_t size = it->file_size();
    total += size;
    if (size > limits.file_bytes) throw std::runtime_error(path.string() + " is too large to be served");
    if (total > limits.total_bytes) throw std::runtime_error("the files in " + folder + " are too large to be served");
    Asset asset;
    asset.content_type = type->content_type;
    asset.immutable = carries_hash(path);
    std::string text = read(path);
    asset.etag = etag_of(text);
    if (type->compressible) {
      asset.gzip = if_smaller(server::gzip(text), text);
      asset.brotli = if_smaller(server::brotli(text), text);
    }
    asset.plain = std::make_shared<const std::string>(std::move(text));
    assets_.emplace(fs::relative(path, root).generic_string(), std::move(asset));
  }
}

Reply Files::answer(const std::string& name, const Call& call) const {
  const auto it = assets_.find(name);
  if (it == assets_.end()) return problem_reply({404, "not_found", "There is no such file.", ""});
  const Asset& asset = it->second;
  const std::string_view accepted = call.header("Accept-Encoding");
  const bool br = asset.brotli && takes_encoding(accepted, "br");
  const bool gz = !br && asset.gzip && takes_encoding(accepted, "gzip");
  const std::string etag = "\"" + asset.etag + (br ? "-br" : gz ? "-gz" : "") + "\"";
  Reply reply;
  reply.with("ETag", etag)
      .with("Cache-Control", asset.immutable ? "public, max-age=31536000, immutable" : "no-cache")
      .with("Vary", "Accept-Encoding");
  if (matches_etag(call.header("If-None-Match"), etag)) {
    reply.status = 304;
    return reply;
  }
  reply.content_type = asset.content_type;
  reply.body = br ? asset.brotli : gz ? asset.gzip : asset.plain;
  if (br || gz) reply.with("Content-Encoding", br ? "br" : "gzip");
  return reply;
}

}  // namespace server
