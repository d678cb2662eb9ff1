// Clients that are slow, malformed, oversized or malicious, byte by byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/support/hostile_bytes.hpp"
#include "tests/support/web_house.hpp"

using namespace std::string_literals;
using testing_support::HttpClient;
using testing_support::RawLine;
using testing_support::WebHouse;

namespace {

server::WebOptions hasty() {
  server::WebOptions options;
  options.limits.http.header = std::chrono::milliseconds(300);
  options.limits.http.idle = std::chrono::milliseconds(600);
  options.limits.http.body_bytes_per_second = 50'000;
  options.limits.per_session = {1e6, 1e6};
  options.limits.per_address = {1e6, 1e6};
  return options;
}

struct Case {
  const char* what;
  std::string request;
  const char* status;  // how the answer begins; empty: closed without a word
};
class HostileHttp : public testing::TestWithParam<Case> {};

TEST_P(HostileHttp, IsAnsweredAndClosed) {
  WebHouse house(hasty());
  RawLine line(house.port);
  line.send(GetParam().request);
  const std::string answer = line.read();
  EXPECT_TRUE(line.closed());
  if (*GetParam().status == '\0') {
    EXPECT_EQ(answer, "");
  } else {
    EXPECT_THAT(answer, testing::StartsWith(std::string("HTTP/1.1 ") + GetParam().status)) << GetParam().what;
  }
  EXPECT_EQ(HttpClient(house.port).get("/api/v1/status").status, 200) << "the server goes on";
}

const std::string post = "POST /api/v1/queue HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n";

INSTANTIATE_TEST_SUITE_P(
    All, HostileHttp,
    testing::Values(
        Case{"no request line", "\r\n\r\n\r\n", "400"}, Case{"garbage", "\x01\x02\x03\r\n\r\n", "400"},
        Case{"TLS", "\x16\x03\x01\x02\x00\x01\x00\x01\xFC\x03\x03"s, "400"},
        Case{"HTTP/2", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", "5"}, Case{"HTTP/0.9", "GET /\r\n\r\n", "400"},
        Case{"no Host", "GET / HTTP/1.1\r\n\r\n", "400"},
        Case{"two Hosts", "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", "400"},
        Case{"bare LF", "GET / HTTP/1.1\nHost: x\n\n", "505"},
        Case{"space before the colon", "GET / HTTP/1.1\r\nHost : x\r\n\r\n", "400"},
        Case{"NUL in a header", "GET / HTTP/1.1\r\nHost: x\r\nA: b\0c\r\n\r\n"s, "400"},
        Case{"absolute form", "GET http://x/ HTTP/1.1\r\nHost: x\r\n\r\n", "400"},
        Case{"climbing", "GET /../../etc/passwd HTTP/1.1\r\nHost: x\r\n\r\n", "400"},
        Case{"escaped NUL", "GET /%00 HTTP/1.1\r\nHost: x\r\n\r\n", "400"},
        Case{"long URL", "GET /" + std::string(3000, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n", "414"},
        Case{"large header", "GET / HTTP/1.1\r\nHost: x\r\nA: " + std::string(20'000, 'a') + "\r\n\r\n", "431"},
        Case{"many headers",
             [] {
               std::string text = "GET / HTTP/1.1\r\nHost: x\r\n";
               for (int i = 0; i < 2000; ++i) text += "A" + std::to_string(i) + ": b\r\n";
               return text + "\r\n";
             }(),
             "431"},
        Case{"large body", post + "Content-Length: 70000\r\n\r\n" + std::string(70'000, ' '), "413"},
        Case{"huge length", post + "Content-Length: 99999999999999999999\r\n\r\n{}", "400"},
        Case{"negative length", post + "Content-Length: -1\r\n\r\n{}", "400"},
        Case{"two lengths", post + "Content-Length: 2\r\nContent-Length: 3\r\n\r\n{}x", "400"},
        Case{"length and chunks", post + "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", "400"},
        Case{"chunks and length", post + "Transfer-Encoding: chunked\r\nContent-Length: 2\r\n\r\n0\r\n\r\n", "400"},
        Case{"bad chunk", post + "Transfer-Encoding: chunked\r\n\r\nzz\r\n\r\n", "400"},
        Case{"endless chunks",
             post + "Transfer-Encoding: chunked\r\n\r\n" + "FFFF\r\n" + std::string(0xFFFF, ' ') + "\r\nFFFF\r\n" +
                 std::string(0xFFFF, ' '),
             "413"},
        Case{"strange expectation", post + "Expect: wonders\r\nContent-Length: 2\r\n\r\n{}", "417"},
        Case{"slow header", "GET / HTTP/1.1\r\nHost:", ""},
        Case{"slow body", post + "Content-Length: 100\r\n\r\n{", ""}, Case{"silence", "", ""}));

TEST(Hostile, TricklingHeadersDoNotProlongTheDeadline) {
  WebHouse house(hasty());
  RawLine line(house.port);
  const auto begin = std::chrono::steady_clock::now();
  line.send("GET / HTTP/1.1\r\n");
  for (int i = 0; i < 100 && line.send("A: b\r\n"); ++i) {
    if (!line.read(std::chrono::milliseconds(100)).empty() || line.closed()) break;
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8));
  EXPECT_EQ(HttpClient(house.port).get("/api/v1/status").status, 200);
}

TEST(Hostile, PipelinedRequestsAreAnsweredInOrder) {
  WebHouse house;
  RawLine line(house.port);
  line.send(
      "GET /api/v1/settings HTTP/1.1\r\nHost: x\r\n\r\nGET /api/v1/nothing HTTP/1.1\r\nHost: x\r\nConnection: "
      "close\r\n\r\n");
  const std::string answers = line.read();
  EXPECT_THAT(answers, testing::StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(answers, testing::HasSubstr("HTTP/1.1 404"));
}

TEST(Hostile, AClientThatWaitsForContinueIsToldTo) {
  WebHouse house;
  RawLine line(house.port);
  line.send(post + "Expect: 100-continue\r\nConnection: close\r\nContent-Length: 20\r\n\r\n");
  EXPECT_THAT(line.read(std::chrono::seconds(5), "\r\n\r\n"), testing::StartsWith("HTTP/1.1 100"));
  line.send(R"({"exhibit":"orrery"})");
  EXPECT_THAT(line.read(), testing::StartsWith("HTTP/1.1 201"));
}

TEST(Hostile, TooManyConnectionsAreTurnedAway) {
  server::WebOptions options;
  options.limits.http.connections = 5;
  WebHouse house(options);
  std::vector<std::unique_ptr<RawLine>> lines;
  for (int i = 0; i < 5; ++i) {
    lines.push_back(std::make_unique<RawLine>(house.port));
    lines.back()->send("GET /api/v1/settings HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_THAT(lines.back()->read(std::chrono::seconds(5), "mode"), testing::HasSubstr("200 OK"));
  }
  RawLine sixth(house.port);
  EXPECT_THAT(sixth.read(), testing::StartsWith("HTTP/1.1 503"));
  lines.clear();
  bool again = false;
  for (int i = 0; i < 50 && !again; ++i) {
    try {
      again = HttpClient(house.port).get("/api/v1/settings").status == 200;
    } catch (const boost::system::system_error&) {
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(again) << "places become free again";
}

TEST(Hostile, DamagedRequestsNeverStopTheServer) {
  WebHouse house(hasty());
  const std::string good = post +
                           "Content-Length: 20\r\nCookie: docent_session=0123456789abcdef0123456789abcdef\r\n\r\n" +
                           R"({"exhibit":"orrery"})" +
                           "GET /api/v1/exhibits/orrery?lang=de HTTP/1.1\r\nHost: x\r\nAccept-Encoding: "
                           "gzip\r\nIf-None-Match: \"x\"\r\n\r\n";
  const auto gen = testing_support::damaged(good);
  for (int i = 0; i < 150; ++i) {
    const std::string bytes = gen(rc::Random(static_cast<std::uint64_t>(i)), 50).value();
    RawLine line(house.port);
    line.send(bytes);
    line.read(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(HttpClient(house.port).get("/api/v1/status").status, 200);
}

TEST(Hostile, DamagedFramesNeverStopTheServer) {
  WebHouse house(hasty());
  const std::string hello =
      "GET /ws HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: keep-alive, Upgrade\r\nSec-WebSocket-Version: "
      "13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  // {"type":"ping","id":1} with a mask of zeros, a ping, a close.
  const std::string text = R"({"type":"ping","id":1})";
  std::string good = std::string("\x81") + static_cast<char>(0x80 | text.size()) + std::string(4, '\0') + text;
  good += std::string("\x89\x82\0\0\0\0ab", 8) + std::string("\x88\x82\0\0\0\0\x03\xE8", 8);
  const auto gen = testing_support::damaged(good);
  for (int i = 0; i < 150; ++i) {
    RawLine line(house.port);
    line.send(hello + gen(rc::Random(static_cast<std::uint64_t>(i)), 50).value());
    line.read(std::chrono::milliseconds(5));
  }
  testing_support::WebSocketClient viewer(house.port);
  viewer.await("hello");
}

}  // namespace
