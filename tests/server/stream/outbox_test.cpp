#include "server/stream/outbox.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "server/stream/token_bucket.hpp"
#include "server/stream/topics.hpp"

using server::Frame;
using server::Outbox;

namespace {

Frame frame(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

TEST(Outbox, KeepsTheNewestStateAndAllEvents) {
  Outbox box(2);
  box.put(0, frame("pose 1"));
  box.push(frame("said"));
  box.put(0, frame("pose 2"));
  box.put(1, frame("status"));
  box.push(frame("arrived"));
  EXPECT_TRUE(box.push_first(frame("pong")));
  for (const char* expected : {"pong", "said", "arrived", "pose 2", "status"}) EXPECT_EQ(*box.take(), expected);
  EXPECT_EQ(box.take(), nullptr);
  EXPECT_EQ(box.dropped(), 0u) << "replaced state is no loss";
}

TEST(Outbox, TakesStateInTurn) {
  Outbox box(3);
  std::string order;
  for (int i = 0; i < 6; ++i) {
    for (std::size_t slot = 0; slot < 3; ++slot) box.put(slot, frame(std::string(1, static_cast<char>('a' + slot))));
    order += *box.take();
  }
  EXPECT_EQ(order, "abcabc") << "a slot that is always full must not starve the others";
}

TEST(Outbox, DropsOldEventsAndCountsThem) {
  Outbox box(1, {.bytes = 1000, .events = 3});
  for (int i = 0; i < 5; ++i) box.push(frame(std::to_string(i)));
  EXPECT_EQ(box.take_dropped(), 2u);
  EXPECT_EQ(*box.take(), "2");
}

TEST(Outbox, LetsPicturesGoBeforeEvents) {
  Outbox box(1, {.bytes = 100, .events = 10});
  box.put(0, frame(std::string(90, 'p')));
  box.push(frame(std::string(50, 'e')));
  EXPECT_EQ(box.dropped(), 1u);
  EXPECT_EQ(box.take()->front(), 'e');
  EXPECT_EQ(box.take(), nullptr);
}

TEST(Outbox, RefusesMoreAnswersThanAClientReads) {
  Outbox box(1);
  int taken = 0;
  while (taken < 1000 && box.push_first(frame("pong"))) ++taken;
  EXPECT_LT(taken, 100);
}

// Under any sequence of calls the bytes counted are those held, and never more than allowed (answers aside, which have
// a bound of their own).
RC_GTEST_PROP(Outbox, StaysWithinItsBounds, ()) {
  const server::OutboxLimits limits{.bytes = 500, .events = 5};
  Outbox box(4, limits);
  const auto steps = *rc::gen::inRange(1, 200);
  std::size_t answers = 0;
  for (int i = 0; i < steps; ++i) {
    const Frame some = frame(std::string(*rc::gen::inRange<std::size_t>(1, 300), 'x'));
    switch (*rc::gen::inRange(0, 5)) {
      case 0:
        box.push(some);
        break;
      case 1:
        box.take();
        break;
      case 2:
        box.clear(*rc::gen::inRange<std::size_t>(0, 4));
        break;
      case 3:
        if (box.bytes() == 0 && box.push_first(frame("pong"))) ++answers;
        break;
      default:
        box.put(*rc::gen::inRange<std::size_t>(0, 4), some);
    }
    RC_ASSERT(box.bytes() <= limits.bytes + 4 * answers);
  }
  std::size_t left = box.bytes();
  while (const Frame some = box.take()) left -= some->size();
  RC_ASSERT(left == 0u);
  RC_ASSERT(box.empty());
}

TEST(TokenBucket, GivesABurstAndThenARate) {
  const auto start = std::chrono::steady_clock::time_point{} + std::chrono::hours(1);
  server::TokenBucket bucket({3.0, 0.5}, start);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bucket.take(start));
  EXPECT_FALSE(bucket.take(start));
  EXPECT_EQ(bucket.wait_seconds(start), 2);
  EXPECT_FALSE(bucket.take(start + std::chrono::milliseconds(1900)));
  EXPECT_TRUE(bucket.take(start + std::chrono::milliseconds(2000)));
  EXPECT_TRUE(bucket.full(start + std::chrono::minutes(1)));
}

TEST(Topics, AreFoundByName) {
  const std::vector<std::string> cameras{"front", "hall"};
  EXPECT_TRUE(server::topics_named("scan", cameras)->test(server::index(server::Topic::scan_rear)));
  EXPECT_TRUE(server::topics_named("camera:hall", cameras)->test(server::camera_topic(1)));
  EXPECT_TRUE(server::topics_named("hello", cameras)->none());
  EXPECT_EQ(server::topics_named("camera:cellar", cameras), std::nullopt);
  EXPECT_EQ(server::topics_named("drive", cameras), std::nullopt);
}

}  // namespace
