#include "protocols/web/decode.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "protocols/web/names.hpp"
#include "protocols/web/utf8.hpp"
#include "tests/support/hostile_bytes.hpp"

using namespace protocols::web;

namespace {

template <typename T>
std::string code(const Decoded<T>& decoded) {
  const auto* problem = std::get_if<Problem>(&decoded);
  return problem ? problem->code : "";
}

TEST(Names, AreTrimmedAndVisible) {
  EXPECT_EQ(std::get<std::string>(decode_name("  Zoë Müller-Ω  ")), "Zoë Müller-Ω");
  EXPECT_EQ(std::get<std::string>(decode_name("木村")), "木村");
  EXPECT_EQ(std::get<std::string>(decode_name(std::string(40, 'x'))).size(), 40u);
  for (const std::string& bad : {std::string(), std::string("   "), std::string(41, 'x'), std::string("a\nb"),
                                 std::string("a\0b", 3), std::string("a\x7F"), std::string("a\xC2\x85"),
                                 std::string("\xE2\x80\xAE"
                                             "evil"),
                                 std::string("zero\xE2\x80\x8Bwidth"), std::string("\xFF"),
                                 std::string("\xEF\xBB\xBF"
                                             "x")}) {
    EXPECT_EQ(code(decode_name(bad)), "bad_name") << bad;
  }
}

TEST(Queue, TakesExhibitsAndPoints) {
  const auto exhibit = std::get<QueueBody>(decode_queue(R"({"exhibit":"orrery","viewpoint":2,"name":"Ada"})"));
  EXPECT_EQ(std::get<robot::ExhibitTarget>(exhibit.target).viewpoint, 2);
  EXPECT_EQ(exhibit.name, "Ada");
  const auto point = std::get<QueueBody>(decode_queue(R"({"x":1.5,"y":-2,"theta":7})"));
  EXPECT_EQ(std::get<robot::PointTarget>(point.target).point, (robot::Point{1.5, -2}));
  EXPECT_NEAR(*std::get<robot::PointTarget>(point.target).theta, 7 - 2 * robot::pi, 1e-12);
  EXPECT_EQ(point.name, std::nullopt);
  EXPECT_EQ(std::get<QueueBody>(decode_queue(R"({"exhibit":"a","name":null})")).name, std::nullopt);
}

TEST(Queue, SaysWhichFieldToMend) {
  const auto problem = std::get<Problem>(decode_queue(R"({"x":1,"y":"2"})"));
  EXPECT_EQ(problem.field, "y");
  EXPECT_EQ(problem.status, 422);
  EXPECT_EQ(std::get<Problem>(decode_queue(R"({"exhibt":"a"})")).field, "exhibt");
  EXPECT_EQ(code(decode_queue(R"({"exhibit":""})")), "bad_length");
  EXPECT_EQ(code(decode_queue(R"({"exhibit":")" + std::string(65, 'x') + R"("})")), "bad_length");
  EXPECT_EQ(code(decode_queue("{}")), "missing_field");
  EXPECT_EQ(code(decode_queue(R"({"exhibit":"a","viewpoint":1.5})")), "bad_number");
}

TEST(Pose, IsWhollyGivenOrGlobal) {
  EXPECT_EQ(std::get<PoseBody>(decode_pose(R"({"x":1,"y":2,"theta":0.5})")).pose, (robot::Pose{1, 2, 0.5}));
  EXPECT_EQ(std::get<PoseBody>(decode_pose(R"({"global":true})")).pose, std::nullopt);
  EXPECT_EQ(code(decode_pose(R"({"global":false})")), "wrong_type");
  EXPECT_EQ(code(decode_pose(R"({"global":true,"x":1})")), "ambiguous_pose");
  EXPECT_EQ(code(decode_pose(R"({"x":1,"y":2})")), "missing_field");
}

TEST(Others, TakeTheirWordsOnly) {
  EXPECT_EQ(std::get<robot::TourAnswer>(decode_tour_answer(R"({"answer":"more"})")), robot::TourAnswer::more);
  EXPECT_EQ(code(decode_tour_answer(R"({"answer":"MORE"})")), "bad_answer");
  EXPECT_EQ(std::get<robot::Mode>(decode_settings(R"({"mode":"web_only"})")), robot::Mode::web_only);
  EXPECT_EQ(code(decode_settings(R"({"mode":3})")), "wrong_type");
  EXPECT_EQ(code(decode_session(R"({"name":"a","password":"b"})")), "missing_field");
  EXPECT_EQ(std::get<TourBody>(decode_tour(R"({"tour":"short"})")).tour, "short");
}

TEST(ClientMessages, AreThree) {
  EXPECT_THAT(std::get<Subscribe>(std::get<ClientMessage>(
                                      decode_client_message(R"({"type":"subscribe","topics":["pose","camera:a"]})")))
                  .topics,
              testing::ElementsAre("pose", "camera:a"));
  EXPECT_EQ(
      std::get<Resume>(std::get<ClientMessage>(decode_client_message(R"({"type":"resume","epoch":"e","last_seq":9})")))
          .last_seq,
      9u);
  EXPECT_EQ(std::get<Ping>(std::get<ClientMessage>(decode_client_message(R"({"type":"ping","id":4})"))).id, 4u);
  EXPECT_EQ(code(decode_client_message(R"({"type":"drive"})")), "unknown_type");
  EXPECT_EQ(code(decode_client_message(R"({"type":"resume","epoch":"e","last_seq":-1})")), "bad_number");
  EXPECT_EQ(code(decode_client_message(R"({"type":"subscribe","topics":"pose"})")), "wrong_type");
}

TEST(EnumNames, StandInTheOrderOfTheirEnumerators) {
  EXPECT_STREQ(name_of(robot::Activity::faulted), "faulted");
  EXPECT_STREQ(name_of(robot::Activity::explaining), "explaining");
  EXPECT_STREQ(name_of(robot::Why::motors_off), "motors_off");
  EXPECT_STREQ(name_of(robot::Why::recording), "recording");
  EXPECT_STREQ(name_of(robot::Why::bumped), "bumped");
  EXPECT_STREQ(name_of(robot::Why::people_in_the_way), "people_in_the_way");
  EXPECT_STREQ(name_of(robot::RequestState::failed), "failed");
  EXPECT_STREQ(name_of(robot::Channel::program), "program");
  EXPECT_STREQ(name_of(robot::Cue::farewell), "farewell");
  EXPECT_STREQ(name_of(robot::Severity::incident), "incident");
  EXPECT_STREQ(name_of(robot::HazardKind::keep_out), "keep_out");
  for (const auto mode : {robot::Mode::open, robot::Mode::web_only, robot::Mode::staff})
    EXPECT_EQ(mode_named(name_of(mode)), mode);
}

// Whatever comes: a value within its bounds, or a problem with a status a client may see. Never an exception.
RC_GTEST_PROP(Decoders, SurviveDamage, ()) {
  const std::string good = *rc::gen::element<std::string>(
      R"({"exhibit":"orrery","viewpoint":2,"name":"Ada"})", R"({"x":1.5,"y":-2e0,"theta":7,"name":"\u00e4"})",
      R"({"type":"subscribe","topics":["pose","status"]})", R"({"global":true})", R"({"name":"Ada"})");
  const std::string bytes = *testing_support::damaged(good);
  const auto sound = [](const Problem& problem) {
    return (problem.status == 400 || problem.status == 422) && !problem.code.empty() && !problem.detail.empty();
  };
  const auto queue = decode_queue(bytes);
  if (const auto* problem = std::get_if<Problem>(&queue)) {
    RC_ASSERT(sound(*problem));
  } else if (const auto* point = std::get_if<robot::PointTarget>(&std::get<QueueBody>(queue).target)) {
    RC_ASSERT(robot::is_finite(point->point));
  }
  const auto message = decode_client_message(bytes);
  if (const auto* problem = std::get_if<Problem>(&message)) RC_ASSERT(sound(*problem));
  const auto pose = decode_pose(bytes);
  if (const auto* problem = std::get_if<Problem>(&pose)) RC_ASSERT(sound(*problem));
  const auto name = decode_name(bytes);
  if (const auto* text = std::get_if<std::string>(&name)) RC_ASSERT(is_utf8(*text) && text->size() <= 160);
}

RC_GTEST_PROP(Utf8, TakesWhatItWouldWrite, ()) {
  const auto point = static_cast<char32_t>(*rc::gen::inRange(0, 0x110000));
  RC_PRE(point < 0xD800 || point > 0xDFFF);
  std::string text;
  if (point < 0x80) {
    text = {static_cast<char>(point)};
  } else if (point < 0x800) {
    text = {static_cast<char>(0xC0 | point >> 6), static_cast<char>(0x80 | (point & 0x3F))};
  } else if (point < 0x10000) {
    text = {static_cast<char>(0xE0 | point >> 12), static_cast<char>(0x80 | (point >> 6 & 0x3F)),
            static_cast<char>(0x80 | (point & 0x3F))};
  } else {
    text = {static_cast<char>(0xF0 | point >> 18), static_cast<char>(0x80 | (point >> 12 & 0x3F)),
            static_cast<char>(0x80 | (point >> 6 & 0x3F)), static_cast<char>(0x80 | (point & 0x3F))};
  }
  std::string_view rest = text;
  RC_ASSERT(next_code_point(rest) == point);
  RC_ASSERT(rest.empty());
  RC_ASSERT(is_utf8(text));
  text.pop_back();
  RC_ASSERT(text.empty() || !is_utf8(text));
}

}  // namespace
