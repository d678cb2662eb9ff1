// A hundred viewers of the real program: everybody sees every pose; how far apart is measured and printed.
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <cmath>
#include <map>
#include <thread>

#include "tests/support/server_process.hpp"

using testing_support::ServerProcess;
using testing_support::TemporaryFolder;

namespace {

namespace net = boost::asio;
using Clock = std::chrono::steady_clock;

// Pose messages in a viewer's stream: their times as text. Keeps what is cut.
std::vector<std::string> poses_in(std::string& stream) {
  constexpr std::string_view mark = "{\"type\":\"pose\",\"time\":";
  std::vector<std::string> times;
  std::size_t at = 0;
  while ((at = stream.find(mark, at)) != std::string::npos) {
    const std::size_t begin = at + mark.size(), end = stream.find(',', begin);
    if (end == std::string::npos) break;
    times.push_back(stream.substr(begin, end - begin));
    at = end;
  }
  stream.erase(0, at == std::string::npos ? stream.size() - std::min(stream.size(), mark.size()) : at);
  return times;
}

TEST(Fanout, AHundredViewersSeeEveryPose) {
  const TemporaryFolder folder;
  ServerProcess server(folder, {"--visitors=3"});
  net::io_context context;
  constexpr std::size_t count = 100;
  std::vector<net::ip::tcp::socket> viewers;
  std::vector<pollfd> polled;
  for (std::size_t i = 0; i < count; ++i) {
    viewers.emplace_back(context);
    viewers.back().connect({net::ip::make_address("127.0.0.1"), server.port()});
    const std::string hello =
        "GET /ws HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
    net::write(viewers.back(), net::buffer(hello));
    polled.push_back({viewers.back().native_handle(), POLLIN, 0});
  }
  std::vector<std::string> streams(count);
  std::map<std::string, std::vector<Clock::time_point>> arrivals;  // by the pose's time
  const auto begin = Clock::now(), warm = begin + std::chrono::seconds(4), end = warm + std::chrono::seconds(5);
  while (Clock::now() < end) {
    poll(polled.data(), polled.size(), 50);
    const auto now = Clock::now();
    for (std::size_t i = 0; i < count; ++i) {
      if (!(polled[i].revents & POLLIN)) continue;
      char buffer[16384];
      boost::system::error_code error;
      const std::size_t size = viewers[i].read_some(net::buffer(buffer), error);
      ASSERT_FALSE(error) << "viewer " << i << " was cut off: " << error.message();
      streams[i].append(buffer, size);
      for (const auto& time : poses_in(streams[i])) {
        if (now > warm) arrivals[time].push_back(now);
      }
    }
  }
  ASSERT_GT(arrivals.size(), 20u);
  std::vector<double> behind;  // ms after the first viewer
  std::size_t complete = 0;
  for (const auto& [time, times] : arrivals) {
    complete += times.size() == count;
    const auto first = *std::min_element(times.begin(), times.end());
    for (const auto& t : times) behind.push_back(std::chrono::duration<double, std::milli>(t - first).count());
  }
  std::sort(behind.begin(), behind.end());
  std::printf(
      "100 viewers: %zu poses in 5 s, %zu seen by all; behind the first viewer p50 %.1f ms, p99 %.1f ms, max %.1f ms\n",
      arrivals.size(), complete, behind[behind.size() / 2], behind[behind.size() * 99 / 100], behind.back());
  EXPECT_GE(complete + 4, arrivals.size()) << "only the first and last ones may be seen by some";
}

}  // namespace
