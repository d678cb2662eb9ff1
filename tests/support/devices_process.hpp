// The real `docent devices` with a museum of its own: the robot's serial lines, a cable to pull and to spoil. The
// program is named by the environment variable DOCENT; run from the repository's root.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace testing_support {

class DevicesProcess {
 public:
  explicit DevicesProcess(const std::string& visitors = "0") {
    const char* program = std::getenv("DOCENT");
    if (!program) throw std::runtime_error("DOCENT does not name the program");
    if (pipe2(orders_.data(), O_CLOEXEC) != 0 || pipe2(answers_.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error("no pipes");
    }
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("fork failed");
    if (child_ == 0) {
      dup2(orders_[0], STDIN_FILENO);
      dup2(answers_[1], STDOUT_FILENO);
      execl(program, program, "devices", "--list", "--orders", "--visitors", visitors.c_str(), nullptr);
      _exit(127);
    }
    close(orders_[0]);
    close(answers_[1]);
    std::string list;
    while (!list.ends_with("]\n")) list += line() + "\n";
    lines_ = nlohmann::json::parse(list);
  }
  ~DevicesProcess() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    close(orders_[1]);
    close(answers_[0]);
    std::error_code ignored;  // what a killed process leaves
    std::filesystem::remove_all(std::filesystem::path(path("base")).parent_path(), ignored);
  }
  DevicesProcess(const DevicesProcess&) = delete;
  DevicesProcess& operator=(const DevicesProcess&) = delete;

  // Options that make a server drive these.
  std::vector<std::string> options() const {
    return {"--base=" + path("base"), "--laser-front=" + path("laser_front"), "--laser-rear=" + path("laser_rear")};
  }
  // Tells it something and hears the answer.
  std::string order(const std::string& words) {
    const std::string text = words + "\n";
    if (write(orders_[1], text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
      throw std::runtime_error("the devices do not listen");
    }
    return line();
  }

 private:
  std::string path(const std::string& device) const {
    for (const auto& row : lines_) {
      if (row["device"] == device) return row["path"];
    }
    return {};
  }
  std::string line() {
    std::string text;
    for (char c = 0;;) {
      pollfd ready{answers_[0], POLLIN, 0};
      if (poll(&ready, 1, 60'000) != 1 || read(answers_[0], &c, 1) != 1) throw std::runtime_error("no answer");
      if (c == '\n') return text;
      text += c;
    }
  }

  pid_t child_ = -1;
  std::array<int, 2> orders_{}, answers_{};
  nlohmann::json lines_;
};

}  // namespace testing_support
