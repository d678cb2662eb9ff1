// A pseudo-terminal as a device uses it: the master end, raw and non-blocking, and the path under which a client finds
// the other end. The other end is also held open here, so that the line outlives its clients as a cable would.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace devices {

class Pty {
 public:
  // Throws std::system_error when the system has no pseudo-terminal left.
  Pty();
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  int master() const { return master_; }
  const std::string& path() const { return path_; }
  // The rate that the client has set, in baud; 0 for one that has no name.
  int baud() const;
  // Bytes that no client has read yet.
  int unread() const;
  // Writes what the line takes; false when some of it was lost.
  bool write(std::span<const std::uint8_t> bytes) const;

 private:
  int master_ = -1;
  int client_end_ = -1;
  std::string path_;
};

}  // namespace devices
