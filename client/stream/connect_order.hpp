// ConnectOrder: the order in which a link tries the addresses of a world, and the pauses between
// its attempts. A round tries each address once:
//   - the other servers of the newest list, from a random one on, so that the players of a server
//     that ends spread over the others;
//   - the addresses that the user gave, from a random one on;
//   - the address of the last connection.
// A list begins a new round. Its first attempt follows at once, after a short random pause.
// Otherwise the pause before a round doubles from round to round, until a list comes or, if there
// are no other servers, a connection is made. A connection without a list, such as one to a server
// that is full, does not begin a new round: the next address follows.
// Pure: randomness is an argument. Thread: one.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace runstone {

/// Returns a random number below the bound, which is at least 1.
using RandomBelow = std::function<std::uint32_t(std::uint32_t bound)>;

struct ConnectPauses {
  std::int64_t ms_first = 0, ms_max = 0;
};

template <class Address>
class ConnectOrder {
 public:
  struct Attempt {
    Address address;
    bool is_listed = false;     // the address comes from a list, and the user did not give it
    std::int64_t pause_ms = 0;  // before the attempt
  };

  /// `given`: at least one address.
  ConnectOrder(std::vector<Address> given, ConnectPauses pauses, RandomBelow random)
      : given_(std::move(given)),
        pauses_(pauses),
        random_(std::move(random)),
        pause_ms_(pauses.ms_first) {}

  /// Takes a new list: the servers besides the one that the link is connected to.
  void set_others(std::vector<Address> others) {
    others_ = std::move(others);
    has_new_list_ = true;
    pause_ms_ = pauses_.ms_first;
  }
  /// Reports that the newest attempt has made a connection.
  void connected() {
    connected_ = round_[at_ - 1];
    if (others_.empty()) pause_ms_ = pauses_.ms_first;
  }
  /// Returns the next attempt.
  Attempt next() {
    Attempt attempt;
    const bool is_first = round_.empty();
    const bool leaves = std::exchange(has_new_list_, false) && !others_.empty();
    if (leaves || at_ == round_.size()) {
      begin_round();
      if (!is_first) attempt.pause_ms = leaves ? below(2 * pauses_.ms_first) : growing_pause_ms();
    } else {
      attempt.pause_ms = below(pauses_.ms_first);
    }
    attempt.address = round_[at_++];
    attempt.is_listed = !contains(given_, attempt.address);
    return attempt;
  }

 private:
  static bool contains(const std::vector<Address>& all, const Address& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
  }
  std::int64_t below(std::int64_t bound) {
    return random_(static_cast<std::uint32_t>(std::max<std::int64_t>(bound, 1)));
  }
  /// Returns the pause with a random quarter added or subtracted, and doubles the next one.
  std::int64_t growing_pause_ms() {
    const std::int64_t pause_ms = pause_ms_ * 3 / 4 + below(pause_ms_ / 2 + 1);
    pause_ms_ = std::min(pause_ms_ * 2, pauses_.ms_max);
    return pause_ms;
  }
  void begin_round() {
    round_.clear();
    at_ = 0;
    add_from_random(others_);
    add_from_random(given_);
    if (connected_) add(*connected_);
  }
  void add_from_random(const std::vector<Address>& all) {
    if (all.empty()) return;
    const std::size_t first = all.size() == 1 ? 0 : random_(static_cast<std::uint32_t>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) add(all[(first + i) % all.size()]);
  }
  void add(const Address& address) {
    if (!contains(round_, address)) round_.push_back(address);
  }

  const std::vector<Address> given_;
  const ConnectPauses pauses_;
  const RandomBelow random_;
  std::vector<Address> others_;
  std::vector<Address> round_;  // empty before the first attempt
  std::size_t at_ = 0;          // place of the next attempt in the round
  std::int64_t pause_ms_;       // before the next round
  bool has_new_list_ = false;
  std::optional<Address> connected_;  // of the last connection
};

}  // namespace runstone
