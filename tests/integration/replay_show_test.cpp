// A recorded drive on the page, by the real program.
#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "protocols/files/map_server_file.hpp"
#include "tests/support/http_client.hpp"
#include "tests/support/recorded_drive.hpp"
#include "tests/support/server_process.hpp"
#include "tests/support/web_socket_client.hpp"

namespace testing_support {
namespace {

const std::string api = "/api/v1";

class ReplayShow : public testing::Test {
 protected:
  ReplayShow() {
    const Drive written = drive();
    files::write_map_server(folder_.path() / "map.yaml", room());
    command_ = {"replay",  folder_.write("drive.log", written.log),   "--map",   folder_.path() / "map.yaml",
                "--truth", folder_.write("truth.txt", written.truth), "--serve", "--speed=20"};
  }

  TemporaryFolder folder_;
  std::vector<std::string> command_;
};

TEST_F(ReplayShow, MovesTheRobotAlongItsRecordedWay) {
  ServerProcess server = ServerProcess::running(folder_, command_);
  WebSocketClient viewer(server.port());
  viewer.await("hello");
  viewer.send({{"type", "subscribe"}, {"topics", {"pose", "scan", "belief", "status"}}});
  // The circle that was driven, 5 m across around (1.5, 2.5).
  const auto on_circle = [](const Json& m) {
    return std::abs(std::hypot(double(m["x"]) - 1.5, double(m["y"]) - 2.5) - 2.5) < 0.15;
  };
  const Json first = viewer.await("pose", on_circle);
  const auto far_on = [&](const Json& m) {
    return on_circle(m) && std::hypot(double(m["x"]) - double(first["x"]), double(m["y"]) - double(first["y"])) > 2.0;
  };
  viewer.await("pose", far_on);
  const Json status = HttpClient(server.port()).get(api + "/status").json();
  EXPECT_EQ(status["why"], "recording");
  EXPECT_THAT(status["sentence"]["en"], testing::HasSubstr("recorded"));
  EXPECT_EQ(server.stop(), 0);
}

TEST_F(ReplayShow, TakesNoRequests) {
  ServerProcess server = ServerProcess::running(folder_, command_);
  const Response answer = HttpClient(server.port()).post(api + "/queue", {{"x", 1.0}, {"y", 1.0}});
  EXPECT_EQ(answer.status, 409);
  EXPECT_EQ(answer.json()["code"], "recording");
}

}  // namespace
}  // namespace testing_support
