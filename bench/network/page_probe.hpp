// PageProbe: an honest reader of one of the gateway's pages during another measurement. It requests
// the page every 50 ms, and measures the time of each answer. It has its own address and thread.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace runstone::bench {

class PageProbe {
 public:
  /// `port`: of the gateway. `is_encrypted`: it speaks TLS.
  PageProbe(std::uint16_t port, const std::string& page, bool is_encrypted);
  ~PageProbe();
  PageProbe(const PageProbe&) = delete;
  PageProbe& operator=(const PageProbe&) = delete;

  struct Answers {
    std::vector<double> ms;  // from when a request was due, to the whole answer
    std::size_t failed = 0;  // no answer, or another status than 200
  };
  /// Ends the probe. Call it once.
  Answers finish();

 private:
  void run(std::uint16_t port, const std::string& page, bool is_encrypted);
  std::atomic<bool> is_over_{false};
  Answers answers_;
  std::thread thread_;
};

}  // namespace runstone::bench
