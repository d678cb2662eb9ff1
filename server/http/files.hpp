// Files that are served as they are: read and compressed once at the start, then answered from memory. Only what was
// found in the folder then can be asked for, so no path can lead out of it.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "server/http/message.hpp"

namespace server {

struct FilesLimits {
  bool media_only = false;  // pictures and sounds
  std::size_t file_bytes = 32u << 20;
  std::size_t total_bytes = 512u << 20;
};

class Files {
 public:
  Files() = default;
  // All files below `folder` whose type is known (see files.cpp); others and hidden ones are not offered. Files whose
  // name carries a hash ("visit-K3JQ7XWM.js") may be cached for ever. Throws std::runtime_error when the folder cannot
  // be read or is larger than the limits.
  explicit Files(const std::string& folder, FilesLimits limits = {});

  bool has(const std::string& name) const { return assets_.contains(name); }
  std::size_t size() const { return assets_.size(); }
  // The answer to a GET for `name` (relative, no leading slash): 200, 304 or 404. Chooses br, gzip or identity.
  Reply answer(const std::string& name, const Call& call) const;

 private:
  struct Asset {
    std::string content_type;
    std::string etag;  // without quotes and without the encoding's mark
    bool immutable = false;
    std::shared_ptr<const std::string> plain, gzip, brotli;  // compressed ones only where they are smaller
  };

  std::map<std::string, Asset> assets_;
};

// Whether an Accept-Encoding header takes a content coding.
bool takes_encoding(std::string_view accept_encoding, std::string_view coding);
// Whether an If-None-Match header names an entity tag (with its quotes).
bool matches_etag(std::string_view if_none_match, std::string_view etag);
// A strong tag of a content, without quotes.
std::string etag_of(std::string_view content);

std::string gzip(std::string_view text);
std::string brotli(std::string_view text);

}  // namespace server
