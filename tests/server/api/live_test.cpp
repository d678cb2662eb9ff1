// /ws as Beast's own client sees it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/web_house.hpp"

using testing_support::HttpClient;
using testing_support::Json;
using testing_support::RawLine;
using testing_support::WebHouse;
using testing_support::WebSocketClient;

namespace {

robot::PoseEstimate pose_at(double seconds) {
  robot::PoseEstimate pose;
  pose.time = robot::from_seconds(seconds);
  pose.map_from_base.x = seconds;
  return pose;
}

TEST(Live, SaysHelloAndTheNewestState) {
  WebHouse house;
  house.say({pose_at(3.0), robot::Status{}, robot::Path{{{0, 0}, {1, 1}}, 1.4}}, 3.0);
  WebSocketClient viewer(house.port);
  const Json hello = viewer.await("hello");
  EXPECT_EQ(hello["site"], "test-hall");
  EXPECT_EQ(hello["time"], 3.0);
  EXPECT_EQ(hello["session"]["staff"], true);
  EXPECT_EQ(viewer.await("pose")["x"], 3.0) << "those who come late see the newest at once";
  EXPECT_EQ(viewer.await("path")["length"], 1.4);
  house.say({pose_at(3.9)}, 3.9);
  house.say({pose_at(4.0)}, 4.0);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  house.say({}, 4.05);
  EXPECT_EQ(viewer.await("pose", [](const Json& pose) { return pose["x"] == 4.0; })["x"], 4.0)
      << "what was held back comes later";
  viewer.send({{"type", "ping"}, {"id", 5}});
  EXPECT_EQ(viewer.await("pong")["id"], 5);
  viewer.close();
}

TEST(Live, GivesWhatWasSubscribedAndNoMore) {
  WebHouse house;
  WebSocketClient viewer(house.port);
  viewer.send({{"type", "subscribe"}, {"topics", {"scan", "belief", "camera:hall", "nonsense"}}});
  EXPECT_EQ(viewer.await("error")["code"], "unknown_topic");
  robot::ScanView scan;
  scan.ranges = {1.0f, std::nanf("")};
  scan.kinds = {robot::BeamKind::person, robot::BeamKind::no_return};
  house.say({pose_at(1.0), scan, robot::Belief{robot::from_seconds(1), {{1, 2, 3}}}});
  EXPECT_EQ(viewer.await_binary(1).size(), 32u + 10u);
  EXPECT_EQ(viewer.await("belief")["samples"].size(), 1u);
  EXPECT_TRUE(house.web().camera_wanted("hall"));
  house.on_web([&] { house.web().frame("hall", std::make_shared<const std::string>("JPEG"), robot::from_seconds(2)); });
  const std::string picture = viewer.await_binary(3);
  EXPECT_EQ(picture[1], 1) << "the index in GET cameras";
  EXPECT_EQ(picture.substr(12), "JPEG");
  viewer.send({{"type", "subscribe"}, {"topics", {"pose"}}});
  viewer.send({{"type", "ping"}, {"id", 1}});
  viewer.await("pong");
  EXPECT_FALSE(house.web().camera_wanted("hall"));
}

TEST(Live, TellsEveryoneTheQueueAndEachWhatIsTheirs) {
  WebHouse house;
  HttpClient asker(house.port);
  asker.get("/api/v1/session");
  WebSocketClient mine(house.port, asker.cookie()), theirs(house.port);
  const auto made = asker.post("/api/v1/queue", {{"exhibit", "orrery"}});
  ASSERT_EQ(made.status, 201);
  const auto has_one = [](const Json& message) { return message["requests"].size() == 1; };
  EXPECT_EQ(mine.await("queue", has_one)["requests"][0]["yours"], true);
  EXPECT_EQ(theirs.await("queue", has_one)["requests"][0]["yours"], false);
  WebSocketClient late(house.port, asker.cookie());
  EXPECT_EQ(late.await("queue")["requests"][0]["yours"], true);
}

TEST(Live, ReplaysEventsToThoseWhoWereAway) {
  WebHouse house;
  const auto say = [&](const char* words) {
    house.say({robot::Speech{robot::Cue::narration, "orrery", 0, {{"en", words}}, robot::Seconds(5)}});
  };
  std::string epoch;
  std::uint64_t last = 0;
  {
    WebSocketClient viewer(house.port);
    epoch = viewer.await("hello")["epoch"];
    say("one");
    last = viewer.await("speech")["seq"];
  }
  say("two");
  say("three");
  WebSocketClient again(house.port);
  EXPECT_EQ(again.await("hello")["epoch"], epoch);
  again.send({{"type", "resume"}, {"epoch", epoch}, {"last_seq", last}});
  EXPECT_EQ(again.await("speech")["text"]["en"], "two");
  EXPECT_EQ(again.await("speech")["text"]["en"], "three");
  say("four");
  EXPECT_EQ(again.await("speech")["text"]["en"], "four");
  again.send({{"type", "resume"}, {"epoch", "of yesterday"}, {"last_seq", 1}});
  EXPECT_EQ(again.await("error")["code"], "epoch_changed");
}

TEST(Live, TellsHowMuchWasMissedWhenTheRingIsTooShort) {
  WebHouse house;
  WebSocketClient viewer(house.port);
  const std::string epoch = viewer.await("hello")["epoch"];
  viewer.send({{"type", "subscribe"}, {"topics", Json::array()}});
  viewer.send({{"type", "ping"}, {"id", 1}});
  viewer.await("pong");
  std::vector<robot::Output> notes(1500, robot::Note{robot::Severity::info, "n", "text"});
  house.say(notes);
  WebSocketClient again(house.port);
  again.send({{"type", "subscribe"}, {"topics", {"note"}}});
  again.send({{"type", "resume"}, {"epoch", epoch}, {"last_seq", 100}});
  EXPECT_EQ(again.await("lagging")["dropped"], 1500 - 1024 - 100);
}

TEST(Live, AnswersBadWordsAndBadFrames) {
  WebHouse house;
  WebSocketClient viewer(house.port);
  viewer.send_text("not json");
  EXPECT_EQ(viewer.await("error")["code"], "bad_json");
  viewer.send({{"type", "drive"}, {"id", 1}});
  EXPECT_EQ(viewer.await("error")["code"], "unknown_type");
  viewer.send_text(std::string(20'000, 'x'));
  EXPECT_EQ(viewer.await_close(), 1009);
  WebSocketClient flood(house.port);
  for (int i = 0; i < 200; ++i) flood.send({{"type", "ping"}, {"id", i}});
  EXPECT_EQ(flood.await_close(), 1008);
}

TEST(Live, LetsOnlyItsOwnPagesIn) {
  WebHouse house;
  EXPECT_NO_THROW(WebSocketClient(house.port, "", "/ws", "http://127.0.0.1:" + std::to_string(house.port)));
  EXPECT_THROW(WebSocketClient(house.port, "", "/ws", "http://evil.example"), boost::system::system_error);
  HttpClient client(house.port);
  EXPECT_EQ(client.get("/ws").status, 426);
  const HttpClient::Headers good{{"Upgrade", "websocket"},
                                 {"Connection", "Upgrade"},
                                 {"Sec-WebSocket-Version", "8"},
                                 {"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="}};
  EXPECT_EQ(client.get("/ws", good).header("sec-websocket-version"), "13");
  HttpClient::Headers short_key = good;
  short_key[2].second = "13";
  short_key[3].second = "c2hvcnQ=";
  EXPECT_EQ(client.get("/ws", short_key).status, 400);
}

TEST(Live, EndsAViewerThatNeverReadsAndLeavesOthersAlone) {
  server::WebOptions options;
  options.limits.web_socket.stall = std::chrono::seconds(2);
  WebHouse house(options);
  RawLine stalled(house.port);
  stalled.shrink_receive_buffer(4096);
  stalled.send(
      "GET /ws HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  WebSocketClient other(house.port);
  other.await("hello");
  robot::Path path;
  for (int i = 0; i < 5000; ++i) path.points.push_back({i * 0.1, 1.0});
  const auto viewers = [&] { return HttpClient(house.port).get("/api/v1/statistics").json()["viewers"].get<int>(); };
  bool both = false, alone = false;
  for (int i = 0; i < 300 && !alone; ++i) {
    path.length = i;
    house.say({path}, 0.05 * i);
    EXPECT_EQ(other.await("path", [&](const Json& message) { return message["length"] == i; })["length"], i);
    const int count = viewers();
    both = both || count == 2;
    alone = both && count == 1;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(alone) << "the stalled viewer was not ended";
}

TEST(Live, SaysFarewell) {
  WebHouse house;
  WebSocketClient viewer(house.port);
  viewer.await("hello");
  house.on_web([&] { house.web().stop(); });
  EXPECT_EQ(viewer.await_close(), 1001);
}

}  // namespace
