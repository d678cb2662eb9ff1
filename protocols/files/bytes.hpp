// Whole files as bytes, plain or gzipped, never more than the caller allows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace files {

// Reads a file; gzip is recognised by its magic bytes and unpacked. Throws FileError when the file cannot be read, is
// cut or damaged (gzip), or holds more than max_bytes after unpacking.
std::string read_bytes(const std::filesystem::path& path, std::size_t max_bytes);

// Replaces a file as a whole: written beside it first, then renamed, so that a reader never sees half of it.
// Throws FileError.
void write_bytes(const std::filesystem::path& path, std::string_view bytes);

// Unpacks gzip. Throws FileError with `name` as the file.
std::string gunzip(std::string_view packed, std::size_t max_bytes, const std::string& name);

}  // namespace files
