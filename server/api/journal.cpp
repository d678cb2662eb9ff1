#include "server/api/journal.hpp"

#include <spdlog/spdlog.h>

namespace server {
namespace {

constexpr std::size_t most_waiting = 10'000;  // jobs kept while the disk fails

}  // namespace

Journal::Journal(net::io_context& context, std::unique_ptr<Store> store)
    : context_(context), store_(std::move(store)), retry_(context) {}

Journal::~Journal() { finish(); }

void Journal::write(Job job) {
  queue_.push_back(std::move(job));
  ++queued_;
  if (queue_.size() > most_waiting) queue_.erase(queue_.begin());
  if (healthy_) begin();
}

net::awaitable<bool> Journal::written() {
  if (kept_ >= queued_) co_return healthy_;
  Waiter waiter{queued_, net::steady_timer(context_, Clock::time_point::max())};
  const auto place = waiters_.insert(waiters_.end(), &waiter);
  begin();
  error_code ignored;
  co_await waiter.ready.async_wait(quietly(ignored));
  waiters_.erase(place);
  co_return waiter.good;
}

// All jobs in one transaction. When that fails for a reason that lies in one job, the jobs are tried one by one and the
// bad one is given up; when the disk fails, what is not written comes back.
Journal::Outcome Journal::commit(Store& store, std::vector<Job> jobs) {
  Outcome outcome;
  try {
    store.transaction([&](Store& inside) {
      for (const Job& job : jobs) job(inside);
    });
    return outcome;
  } catch (const std::exception& error) {
    outcome.trouble = error.what();
  }
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    try {
      store.transaction(jobs[i]);
    } catch (const std::exception& error) {
      outcome.good = false;
      outcome.trouble = error.what();
      if (!means_disk_trouble(error)) continue;
      outcome.left.assign(jobs.begin() + static_cast<std::ptrdiff_t>(i), jobs.end());
      break;
    }
  }
  return outcome;
}

void Journal::begin() {
  if (busy_ || finished_ || queue_.empty()) return;
  busy_ = true;
  net::post(worker_, [this, jobs = std::exchange(queue_, {}), last = queued_]() mutable {
    Outcome outcome = commit(*store_, std::move(jobs));
    net::post(context_, [this, outcome = std::move(outcome), last]() mutable { done(std::move(outcome), last); });
  });
}

void Journal::done(Outcome outcome, std::uint64_t last) {
  if (finished_) return;
  busy_ = false;
  if (!outcome.good) spdlog::error("database: {}", outcome.trouble);
  healthy_ = outcome.left.empty();
  if (healthy_) kept_ = last;
  for (Waiter* waiter : waiters_) {
    if (waiter->job > last) continue;
    waiter->good = outcome.good;
    waiter->ready.cancel();
  }
  if (healthy_) return begin();
  queue_.insert(queue_.begin(), std::make_move_iterator(outcome.left.begin()),
                std::make_move_iterator(outcome.left.end()));
  retry_.expires_after(std::chrono::seconds(1));
  retry_.async_wait([this](error_code error) {
    if (!error) begin();
  });
}

void Journal::finish() {
  if (std::exchange(finished_, true)) return;
  retry_.cancel();
  net::post(worker_, [this, jobs = std::exchange(queue_, {})]() mutable {
    if (const Outcome outcome = commit(*store_, std::move(jobs)); !outcome.good)
      spdlog::error("database: {}", outcome.trouble);
  });
  worker_.join();
}

}  // namespace server
