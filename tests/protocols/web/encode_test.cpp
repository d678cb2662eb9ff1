// What goes out, held against tests/golden/*.json, which the browser's tests read too.
#include "protocols/web/encode.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "protocols/web/frames.hpp"
#include "tests/support/small_museum.hpp"

using namespace protocols::web;

namespace {

robot::PoseEstimate a_pose() {
  robot::PoseEstimate pose;
  pose.time = robot::from_seconds(12.5);
  pose.map_from_base = {1.23456, -2.0, 0.5};
  pose.sigma_position = 0.03;
  pose.sigma_theta = 0.01;
  pose.localized = true;
  pose.twist = {0.4, -0.1};
  return pose;
}

robot::Request a_request() {
  robot::Request request;
  request.id = 7;
  request.requester = {"Mirela", robot::Channel::web, "secret-session"};
  request.target = robot::ExhibitTarget{"orrery", {}};
  request.asked = robot::from_seconds(3);
  request.position = 2;
  request.eta_seconds = 41.3;
  return request;
}

Json a_status() {
  robot::Status status;
  status.activity = robot::Activity::driving;
  status.why = robot::Why::requested;
  status.exhibit = "orrery";
  status.requester = "Mirela";
  status.distance_to_go = 14.0;
  status.seconds_to_go = 40.0;
  status.people_near = 3;
  status.battery_fraction = 0.75;
  status.speed_limit = 0.7;
  Json message = {{"type", "status"}};
  message.update(
      encode_status({robot::from_seconds(12.5),
                     status,
                     a_pose(),
                     {{"en", "I am on my way to the orrery."}, {"de", "Ich bin unterwegs zur Planetenmaschine."}},
                     {{"en", "14 m to go."}, {"de", "Noch 14 m."}}}));
  return message;
}

robot::ScanView a_scan() {
  robot::ScanView scan;
  scan.time = robot::from_seconds(2.5);
  scan.laser = robot::LaserId::rear;
  scan.map_from_laser = {1, 2, 3};
  scan.angle_min = -1.5;
  scan.angle_step = 0.5;
  scan.ranges = {4.0f, std::nanf("")};
  scan.kinds = {robot::BeamKind::person, robot::BeamKind::no_return};
  return scan;
}

std::string hex(const std::string& bytes) {
  std::string text;
  for (const char byte : bytes) {
    for (const int shift : {4, 0}) text.push_back("0123456789abcdef"[static_cast<unsigned char>(byte) >> shift & 15]);
  }
  return text;
}

Json event(Json message) {
  message["seq"] = 9;
  return message;
}

// File name to content. Messages of /ws have their type as name, answers of REST "rest_" before it.
std::map<std::string, Json> messages() {
  robot::Path path{{{1.0, 2.0}, {3.14159, 4.0}}, 2.9};
  robot::People people;
  people.time = robot::from_seconds(12.5);
  people.people.resize(1);
  people.people[0].position = {1.0, 2.5};
  robot::Belief belief{robot::from_seconds(12.5), {{1, 2, 0.1234}}};
  robot::VelocitySpace space{{0.0, 0.5}, {-0.5, 0.5}, {0.125f, std::nanf(""), 0.75f, 1.0f}, {0.5, 0.5}};
  robot::Speech speech{robot::Cue::narration, "orrery", 0, {{"en", "Look."}, {"de", "Schau."}}, robot::Seconds(20)};
  const robot::Museum museum = testing_support::small_museum();
  Json status = a_status(), exhibits = Json::array();
  status.erase("type");
  for (const auto& exhibit : museum.exhibits) exhibits.push_back(encode_exhibit(exhibit, "en"));
  return {{"pose", pose_message(a_pose())},
          {"status", a_status()},
          {"path", path_message(path)},
          {"people", people_message(people)},
          {"belief", belief_message(belief)},
          {"velocity_space", velocity_space_message(space)},
          {"queue", {{"type", "queue"}, {"requests", Json::array({encode_request(a_request(), true)})}}},
          {"request", event({{"type", "request"}, {"request", encode_request(a_request(), false)}})},
          {"speech", event(speech_message(speech, robot::from_seconds(12.5)))},
          {"note", event(note_message({robot::Severity::warning, "bumped", "Somebody leant on it."},
                                      robot::from_seconds(12.5)))},
          {"visit", event(visit_message({"orrery", {7}, robot::from_seconds(1), robot::from_seconds(21), true}))},
          {"scan", {{"hex", hex(encode_scan(a_scan()))}}},
          {"picture", {{"hex", hex(encode_camera_head(1, robot::from_seconds(12.5)) + "\xFF\xD8\xFF\xD9")}}},
          {"rest_status", status},
          {"rest_site", encode_site(museum, robot::Footprint{})},
          {"rest_exhibits", exhibits},
          {"rest_tours", Json::array({encode_tour(museum.tours[0], museum, "en")})},
          {"rest_map", encode_map(museum.map, "/api/v1/map.png")},
          {"rest_request", encode_request(a_request(), true)},
          {"rest_problem", encode(problem_of(robot::Refusal::inside_obstacle))}};
}

// DOCENT_WRITE_GOLDEN=1 writes the files anew: look at the difference before you commit it.
TEST(Golden, MessagesAreAsBothSidesKnowThem) {
  for (const auto& [name, message] : messages()) {
    const std::string path = "tests/golden/" + name + ".json";
    if (std::getenv("DOCENT_WRITE_GOLDEN")) std::ofstream(path) << message.dump(2) << "\n";
    std::ifstream file(path);
    ASSERT_TRUE(file) << path << " is missing (run from the repository's root)";
    EXPECT_EQ(message, Json::parse(file)) << message.dump();
  }
}

TEST(Json, NeverCarriesNaN) {
  EXPECT_EQ(number(std::nan("")), nullptr);
  EXPECT_EQ(number(INFINITY), nullptr);
  EXPECT_EQ(number(1.00004), 1.0);
  EXPECT_EQ(number(1e308), 1e308);
  EXPECT_EQ(number(-0.123456).dump(), "-0.1235");
}

TEST(Requests, KeepTheSessionSecret) {
  EXPECT_THAT(encode_request(a_request(), true).dump(), testing::Not(testing::HasSubstr("secret")));
}

TEST(Scans, HaveTheLayoutOfTheReadme) {
  const std::string bytes = encode_scan(a_scan());
  ASSERT_EQ(bytes.size(), 32u + 2 * 5);
  const auto f32 = [&](std::size_t at) {
    float value;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  double time;
  std::memcpy(&time, bytes.data() + 4, 8);
  EXPECT_EQ(bytes.substr(0, 4), std::string("\x01\x01\x02\x00", 4));
  EXPECT_EQ(time, 2.5);
  EXPECT_EQ(f32(12), 1.0f);
  EXPECT_EQ(f32(20), 3.0f);
  EXPECT_EQ(f32(24), -1.5f);
  EXPECT_EQ(f32(32), 4.0f);
  EXPECT_TRUE(std::isnan(f32(36)));
  EXPECT_EQ(bytes.substr(40), std::string("\x02\x00", 2));
  EXPECT_EQ(encode_camera_head(5, robot::Time{}), std::string("\x03\x05\0\0\0\0\0\0\0\0\0\0", 12));
}

TEST(Problems, AreAsRfc9457SaysThem) {
  const Json json = encode(problem_of(robot::Refusal::inside_obstacle));
  EXPECT_EQ(json["status"], 422);
  EXPECT_EQ(json["code"], "inside_obstacle");
  EXPECT_EQ(json["title"], "Unprocessable Content");
  for (int i = 1; i <= static_cast<int>(robot::Refusal::recording); ++i) {
    const Problem problem = problem_of(static_cast<robot::Refusal>(i));
    EXPECT_NE(problem.code, "internal") << i;
    EXPECT_STRNE(status_title(problem.status), "Internal Server Error") << i;
  }
}

}  // namespace
