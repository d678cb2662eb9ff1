// The store as the web thread sees it: a worker thread of its own, writes gathered into one transaction while the disk
// is busy, and a way to wait until everything said so far is on the disk.
#pragma once

#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <list>
#include <memory>
#include <vector>

#include "server/store/store.hpp"
#include "server/stream/asio.hpp"

namespace server {

class Journal {
 public:
  using Job = std::function<void(Store&)>;

  Journal(net::io_context& context, std::unique_ptr<Store> store);
  ~Journal();

  // Queues a write. When the disk fails it is tried again every second; a bounded number is kept. Jobs must be
  // repeatable.
  void write(Job job);
  // True once all that was written before is on the disk; false as soon as the disk has failed with it.
  net::awaitable<bool> written();
  // Runs a question on the worker.
  template <typename T>
  net::awaitable<T> ask(std::function<T(Store&)> question) {
    Store& store = *store_;
    const auto work = [&store, question]() -> net::awaitable<T> { co_return question(store); };
    co_return co_await net::co_spawn(worker_, work, net::use_awaitable);
  }

  bool healthy() const { return healthy_; }
  std::size_t waiting() const { return queue_.size(); }
  // Writes what waits and ends the worker. Nothing may be asked afterwards.
  void finish();

 private:
  struct Waiter {
    std::uint64_t job;
    net::steady_timer ready;
    bool good = false;
  };
  struct Outcome {
    bool good = true;
    std::string trouble;
    std::vector<Job> left;  // to be tried again
  };

  static Outcome commit(Store& store, std::vector<Job> jobs);
  void begin();
  void done(Outcome outcome, std::uint64_t last);

  net::io_context& context_;
  std::unique_ptr<Store> store_;
  net::thread_pool worker_{1};
  net::steady_timer retry_;
  std::vector<Job> queue_;
  std::list<Waiter*> waiters_;
  std::uint64_t queued_ = 0;  // jobs ever
  std::uint64_t kept_ = 0;    // of them, on the disk
  bool busy_ = false;
  bool healthy_ = true;
  bool finished_ = false;
};

}  // namespace server
