#include "server/store/store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

using server::Store;
using testing_support::TemporaryFolder;

namespace {

robot::Request a_request(robot::RequestId id) {
  robot::Request request;
  request.id = id;
  request.requester = {"Zoë; DROP TABLE request", robot::Channel::kiosk, "s1"};
  request.target = robot::ExhibitTarget{"orrery", 2};
  return request;
}

TEST(Store, RemembersRequestsAcrossOpenings) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "below" / "docent.db").string();
  {
    Store store(file, 1000);
    EXPECT_EQ(store.next_request_id(), 1u);
    robot::Request point = a_request(2);
    point.target = robot::PointTarget{{1.5, -2.25}, 0.5};
    store.put_request(a_request(1), 1001);
    store.put_request(point, 1002);
    robot::Request done = a_request(3);
    store.put_request(done, 1003);
    done.state = robot::RequestState::fulfilled;
    store.put_request(done, 1004);
  }
  Store store(file, 2000);
  const auto open = store.open_requests();
  ASSERT_EQ(open.size(), 2u);
  EXPECT_EQ(open[0].request.requester.name, "Zoë; DROP TABLE request");
  EXPECT_EQ(open[0].request.requester.channel, robot::Channel::kiosk);
  EXPECT_EQ(std::get<robot::ExhibitTarget>(open[0].request.target).viewpoint, 2);
  EXPECT_EQ(std::get<robot::PointTarget>(open[1].request.target).point, (robot::Point{1.5, -2.25}));
  EXPECT_EQ(open[1].asked, 1002);
  ASSERT_EQ(store.ended_requests(5).size(), 1u);
  EXPECT_EQ(store.find_request(3)->asked, 1003) << "when it was asked, not when it changed";
  EXPECT_EQ(store.find_request(9), std::nullopt);
  EXPECT_EQ(store.next_request_id(), 4u);
  EXPECT_EQ(store.statistics().requests, 3u);
  EXPECT_EQ(store.statistics().fulfilled, 1u);
  EXPECT_EQ(store.statistics().since, 1000);
}

TEST(Store, AddsUpVisitsAndTravel) {
  Store store(":memory:", 0);
  store.add_visit({"orrery", 20, true, 100});
  store.add_visit({"orrery", 5, false, 200});
  store.add_travel(10.5, 60);
  store.add_travel(1.5, 60);
  const auto statistics = store.statistics();
  EXPECT_EQ(statistics.distance, 12.0);
  EXPECT_EQ(statistics.seconds, 120.0);
  ASSERT_EQ(statistics.exhibits.size(), 1u);
  EXPECT_EQ(statistics.exhibits[0].visits, 2u);
  EXPECT_EQ(statistics.exhibits[0].seconds, 25.0);
}

TEST(Store, KeepsAnswersForADay) {
  Store store(":memory:", 0);
  store.put_answer("key", {"print", 201, "{}", "/there"}, 1000);
  EXPECT_EQ(store.find_answer("key")->location, "/there");
  store.tidy(1000 + 3600);
  EXPECT_TRUE(store.find_answer("key"));
  store.tidy(1000 + 90000);
  EXPECT_FALSE(store.find_answer("key"));
}

TEST(Store, DoesAllOfATransactionOrNothing) {
  Store store(":memory:", 0);
  EXPECT_THROW(store.transaction([](Store& inside) {
    inside.put_request(a_request(1), 1);
    throw std::runtime_error("in the middle");
  }),
               std::runtime_error);
  EXPECT_TRUE(store.open_requests().empty());
}

TEST(Store, SetsADamagedFileAsideAndSaysSo) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("docent.db", "this is no database at all, but long enough to look like one").string();
  Store store(file, 77);
  EXPECT_THAT(store.notice(), testing::HasSubstr("damaged"));
  EXPECT_TRUE(std::filesystem::exists(file + ".damaged-77"));
  store.put_request(a_request(1), 1);
  EXPECT_EQ(store.open_requests().size(), 1u);
}

TEST(Store, SurvivesBytesFlippedInTheFile) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "docent.db").string();
  {
    Store store(file, 1);
    for (robot::RequestId id = 1; id <= 300; ++id) store.put_request(a_request(id), 1);
  }
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  for (int i = 0; i < 60; ++i) bytes.seekp(4096 + 700 * i).write("\xDE\xAD\xBE\xEF", 4);
  bytes.close();
  Store store(file, 78);
  EXPECT_THAT(store.notice(), testing::HasSubstr("set aside"));
  EXPECT_EQ(store.next_request_id(), 1u);
}

TEST(Store, LeavesOtherProgramsAndNewerFilesAlone) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "other.db").string();
  SQLite::Database(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("PRAGMA application_id = 7; CREATE TABLE t(x)");
  EXPECT_THROW(Store(file, 1), std::runtime_error);
  const std::string newer = (folder.path() / "newer.db").string();
  { Store store(newer, 1); }
  SQLite::Database(newer, SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99");
  EXPECT_THROW(Store(newer, 1), std::runtime_error);
  EXPECT_THROW(Store("/proc/no/such/place.db", 1), std::exception);
}

// A child writes and reports each row after its commit, until it is killed: what it reported is there.
TEST(Store, LosesNothingCommittedWhenTheProcessIsKilled) {
  for (int round = 0; round < 5; ++round) {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "docent.db").string();
    int pipe_ends[2];
    ASSERT_EQ(pipe(pipe_ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      Store store(file, 1);
      for (std::uint32_t id = 1;; ++id) {
        store.transaction([id](Store& inside) { inside.put_request(a_request(id), 1); });
        if (write(pipe_ends[1], &id, sizeof id) != sizeof id) _exit(1);
      }
    }
    close(pipe_ends[1]);
    std::uint32_t last = 0;
    while (last < 20u + 7u * static_cast<unsigned>(round))
      ASSERT_EQ(read(pipe_ends[0], &last, sizeof last), static_cast<ssize_t>(sizeof last));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    while (read(pipe_ends[0], &last, sizeof last) == sizeof last) {
    }
    close(pipe_ends[0]);
    Store store(file, 2);
    EXPECT_EQ(store.notice(), "");
    EXPECT_GE(store.open_requests().size(), last);
  }
}

}  // namespace
