#include "server/tools/devices_tool.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <sstream>
#include <streambuf>
#include <thread>

#include "protocols/files/site_file.hpp"

namespace tools {
namespace {

// Hands what is written to whoever waits for it, whole, at the first flush.
class Announcement : public std::stringbuf {
 public:
  int sync() override {
    if (!told_) said.set_value(str());
    told_ = true;
    return 0;
  }
  std::promise<std::string> said;

 private:
  bool told_ = false;
};

// Runs the command until it has said where the devices are, then interrupts it.
std::string announced(DevicesOptions options) {
  Announcement buffer;
  std::ostream out(&buffer);
  auto said = buffer.said.get_future();
  int code = -1;
  std::thread command([&] { code = devices_main(options, out); });
  std::string text;
  bool all_there = false;
  if (said.wait_for(std::chrono::seconds(60)) == std::future_status::ready) {
    text = said.get();
    if (options.list) {
      all_there = true;
      for (const auto& row : nlohmann::json::parse(text)) {
        all_there = all_there && std::filesystem::is_character_file(row.at("path").get<std::string>());
      }
    }
  }
  std::raise(SIGTERM);
  command.join();
  EXPECT_EQ(code, 0);
  EXPECT_EQ(all_there, options.list);
  return text;
}

TEST(DevicesTool, ListsItsTerminalsAsJsonAndEndsOnASignal) {
  const auto list = nlohmann::json::parse(announced({.visitors = 0, .list = true}));
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0].at("device"), "base");
  EXPECT_EQ(list[1].at("device"), "laser_front");
  EXPECT_EQ(list[2].at("device"), "laser_rear");
  for (const auto& row : list) EXPECT_FALSE(std::filesystem::exists(row.at("path").get<std::string>()));
}

TEST(DevicesTool, SaysThemInWordsToo) {
  EXPECT_THAT(announced({.visitors = 0}),
              testing::AllOf(testing::HasSubstr("laser_rear\t/"), testing::HasSubstr("Ctrl-C")));
}

TEST(DevicesTool, AnUnknownMuseumIsAnError) {
  std::ostringstream out;
  EXPECT_THROW(devices_main({.site = "static/sites/nowhere"}, out), files::SiteError);
}

}  // namespace
}  // namespace tools
