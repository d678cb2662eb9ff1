// The real `docent serve` on a free port, with a database of its own, for HTTP-driven tests. The program is named by
// the environment variable DOCENT; run from the repository's root.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace testing_support {

class ServerProcess {
 public:
  // `more`: further options, as "--visitors=5". `folder` outlives the process: give the same one again to restart.
  explicit ServerProcess(const TemporaryFolder& folder, const std::vector<std::string>& more = {})
      : ServerProcess(folder, {"serve", "--start=home", "--database=" + (folder.path() / "docent.sqlite").string()},
                      more) {}
  // Another of docent's commands that serves.
  static ServerProcess running(const TemporaryFolder& folder, const std::vector<std::string>& command) {
    return {folder, command, {}};
  }
  ~ServerProcess() {
    if (child_ > 0) stop();
  }
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  unsigned short port() const { return port_; }
  // As if the power had gone.
  void kill_at_once() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    child_ = -1;
  }
  // Politely; its exit status. Killed when it does not end within 20 s.
  int stop() {
    kill(child_, SIGTERM);
    int status = 0;
    for (int i = 0; i < 200; ++i) {
      if (waitpid(child_, &status, WNOHANG) == child_) {
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    kill_at_once();
    return -1;
  }
  std::string log() const {
    std::ifstream file(log_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  ServerProcess(const TemporaryFolder& folder, const std::vector<std::string>& command,
                const std::vector<std::string>& more) {
    const char* program = std::getenv("DOCENT");
    if (!program) throw std::runtime_error("DOCENT does not name the program");
    log_ = (folder.path() / "server.log").string();
    std::filesystem::remove(log_);  // an earlier process's port must not be read
    std::vector<std::string> words{program};
    words.insert(words.end(), command.begin(), command.end());
    words.insert(words.end(), {"--port=0", "--bind=127.0.0.1"});
    words.insert(words.end(), more.begin(), more.end());
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("fork failed");
    if (child_ == 0) begin(words);
    wait_for_port();
  }

  [[noreturn]] void begin(const std::vector<std::string>& words) {
    const int out = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    dup2(out, STDOUT_FILENO);
    dup2(out, STDERR_FILENO);
    std::vector<char*> arguments;
    for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  void wait_for_port() {
    constexpr std::string_view mark = "http://localhost:";
    for (int i = 0; i < 600; ++i) {
      const std::string text = log();
      if (const std::size_t at = text.find(mark); at != std::string::npos && text.find('\n', at) != std::string::npos) {
        port_ = static_cast<unsigned short>(std::stoi(text.substr(at + mark.size())));
        return;
      }
      if (waitpid(child_, nullptr, WNOHANG) == child_) {
        child_ = -1;
        throw std::runtime_error("the server did not begin: " + text);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    kill_at_once();
    throw std::runtime_error("the server did not say its port: " + log());
  }

  pid_t child_ = -1;
  unsigned short port_ = 0;
  std::string log_;
};

}  // namespace testing_support
