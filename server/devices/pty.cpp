#include "server/devices/pty.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

namespace devices {
namespace {

struct Rate {
  speed_t code;
  int baud;
};
constexpr Rate rates[] = {{B9600, 9600},     {B19200, 19200},   {B38400, 38400},  {B57600, 57600},
                          {B115200, 115200}, {B230400, 230400}, {B500000, 500000}};

}  // namespace

Pty::Pty() {
  const auto fail = [this](const char* what) {
    const int error = errno;
    if (client_end_ >= 0) ::close(client_end_);
    if (master_ >= 0) ::close(master_);
    throw std::system_error(error, std::generic_category(), what);
  };
  master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master_ < 0) fail("cannot open a pseudo-terminal");
  char name[128];
  if (::grantpt(master_) != 0 || ::unlockpt(master_) != 0 || ::ptsname_r(master_, name, sizeof name) != 0) {
    fail("cannot unlock a pseudo-terminal");
  }
  path_ = name;
  client_end_ = ::open(name, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (client_end_ < 0) fail("cannot open the client's end of a pseudo-terminal");
  termios settings{};
  if (::tcgetattr(client_end_, &settings) != 0) fail("cannot set up a pseudo-terminal");
  ::cfmakeraw(&settings);
  ::cfsetspeed(&settings, B9600);
  if (::tcsetattr(client_end_, TCSANOW, &settings) != 0) fail("cannot set up a pseudo-terminal");
}

Pty::~Pty() {
  ::close(client_end_);
  ::close(master_);
}

int Pty::baud() const {
  termios settings{};
  if (::tcgetattr(client_end_, &settings) != 0) return 0;
  const speed_t speed = ::cfgetospeed(&settings);
  for (const Rate& rate : rates) {
    if (rate.code == speed) return rate.baud;
  }
  return 0;
}

int Pty::unread() const {
  int count = 0;
  return ::ioctl(client_end_, FIONREAD, &count) == 0 ? count : 0;
}

bool Pty::write(std::span<const std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(master_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace devices
