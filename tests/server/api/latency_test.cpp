// From the robot's pose to a hundred sockets, in one process so that one clock measures both ends. Printed, not judged.
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <boost/asio/write.hpp>

#include "tests/support/web_house.hpp"

using testing_support::WebHouse;

namespace {

using Clock = std::chrono::steady_clock;

double now_seconds() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

// The times of the pose messages in a stream, which is emptied but for a cut end.
std::vector<double> pose_times(std::string& stream) {
  constexpr std::string_view mark = "\"type\":\"pose\",\"time\":";
  std::vector<double> times;
  for (std::size_t at; (at = stream.find(mark)) != std::string::npos;) {
    const std::size_t end = stream.find(',', at + mark.size());
    if (end == std::string::npos) return times;
    times.push_back(std::stod(stream.substr(at + mark.size(), end)));
    stream.erase(0, end);
  }
  if (stream.size() > mark.size()) stream.erase(0, stream.size() - mark.size());
  return times;
}

TEST(Latency, OfAPoseToAHundredViewers) {
  WebHouse house;
  namespace net = boost::asio;
  net::io_context context;
  constexpr std::size_t count = 100;
  constexpr int poses = 60;
  std::vector<net::ip::tcp::socket> viewers;
  std::vector<pollfd> polled;
  for (std::size_t i = 0; i < count; ++i) {
    viewers.emplace_back(context);
    viewers.back().connect({net::ip::make_address("127.0.0.1"), house.port});
    const std::string hello =
        "GET /ws HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
    net::write(viewers.back(), net::buffer(hello));
    polled.push_back({viewers.back().native_handle(), POLLIN, 0});
  }
  std::thread robot([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    for (int i = 0; i < poses; ++i) {
      robot::PoseEstimate pose;
      pose.time = robot::from_seconds(now_seconds());
      robot::People people;
      people.people.resize(20);
      house.say({pose, robot::Status{}, people}, now_seconds());
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  std::vector<std::string> streams(count);
  std::vector<double> latencies;  // ms
  const auto end = Clock::now() + std::chrono::seconds(20);
  while (latencies.size() < poses * count && Clock::now() < end) {
    poll(polled.data(), polled.size(), 50);
    for (std::size_t i = 0; i < count; ++i) {
      if (!(polled[i].revents & POLLIN)) continue;
      char buffer[16384];
      boost::system::error_code error;
      streams[i].append(buffer, viewers[i].read_some(net::buffer(buffer), error));
      ASSERT_FALSE(error);
      for (const double time : pose_times(streams[i])) latencies.push_back(1e3 * (now_seconds() - time));
    }
  }
  robot.join();
  ASSERT_EQ(latencies.size(), poses * count) << "every viewer sees every pose";
  std::sort(latencies.begin(), latencies.end());
  std::printf("pose to %zu viewers: p50 %.2f ms, p99 %.2f ms, max %.2f ms (time rounded to 1 ms)\n", count,
              latencies[latencies.size() / 2], latencies[latencies.size() * 99 / 100], latencies.back());
}

}  // namespace
