#include "bench/network/page_probe.hpp"

#include <algorithm>
#include <memory>

#include "bench/network/child.hpp"
#include "common/os/steady_clock.hpp"
#include "tests/support/net/web_peer.hpp"

namespace runstone::bench {
namespace {

constexpr std::uint32_t kReaderAddress = 0x7F040402;  // 127.4.4.2, which nobody else uses
constexpr TimeUs kRequestEveryUs = 50'000;

}  // namespace

PageProbe::PageProbe(std::uint16_t port, const std::string& page, bool is_encrypted)
    : thread_([=, this] { run(port, page, is_encrypted); }) {}

PageProbe::~PageProbe() {
  is_over_ = true;
  if (thread_.joinable()) thread_.join();
}

PageProbe::Answers PageProbe::finish() {
  is_over_ = true;
  thread_.join();
  return answers_;
}

void PageProbe::run(std::uint16_t port, const std::string& page, bool is_encrypted) {
  std::unique_ptr<test::WebPeer> peer;
  for (TimeUs due_us = steady_now_us(); !is_over_; due_us += kRequestEveryUs) {
    const TimeUs left_us = std::max<TimeUs>(due_us - steady_now_us(), 0);
    if (!pause_for(static_cast<double>(left_us) / 1e6)) return;
    if (peer == nullptr || !peer->is_open())
      peer = std::make_unique<test::WebPeer>(port, kReaderAddress, is_encrypted);
    if (peer->get(page).status == 200) {
      answers_.ms.push_back(static_cast<double>(steady_now_us() - due_us) / 1e3);
    } else {
      ++answers_.failed;
    }
  }
}

}  // namespace runstone::bench
