#include "server/web/recent_edits.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>

#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

constexpr TimeUs kEditsAgeUsMax = 1'000'000;
constexpr auto kWait = std::chrono::milliseconds(250);

}  // namespace

boost::asio::awaitable<std::shared_ptr<const std::string>> RecentEdits::newest() {
  if (!map_.is_on()) co_return nullptr;
  const bool is_due = asked_us_ == 0 || asked_us_ + kEditsAgeUsMax < steady_now_us();
  if (is_due && !is_asking_) {
    is_asking_ = true;
    boost::asio::co_spawn(io_, ask(), boost::asio::detached);
  }
  if (is_asking_) {
    boost::asio::steady_timer deadline(io_, kWait);
    waiting_.insert(&deadline);
    boost::system::error_code woken;
    co_await deadline.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, woken));
    waiting_.erase(&deadline);
  }
  co_return newest_;
}

boost::asio::awaitable<void> RecentEdits::ask() {
  const TimeUs asked_us = steady_now_us();
  const MapAnswer answer = co_await map_.recent_edits();
  if (answer.status == 200) newest_ = answer.body;
  if (answer.status == 403) newest_ = nullptr;  // the rights of strangers have changed
  asked_us_ = asked_us;
  is_asking_ = false;
  for (boost::asio::steady_timer* waiting : waiting_) waiting->cancel();
}

}  // namespace runstone
