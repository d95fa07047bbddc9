// FakePort: a server of edits in memory, for tests of ActionSender. It answers when the test says so.
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "client/build/action_sender.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/limits.hpp"

namespace runstone::test {

class FakePort final : public EditPort {
 public:
  struct Offered {
    EditDescriptor edit;
    ClientSequence action = 0;
    bool is_answered = false;
  };
  std::string closed;
  std::size_t edits_max = std::numeric_limits<std::size_t>::max();
  std::size_t window = 8;
  TimeUs wait = 0;
  std::optional<std::string> refusal;  // of the next offer

  std::string why_closed() const override { return closed; }
  std::size_t action_edits_max() const override { return edits_max; }
  bool has_room(const EditDescriptor& /*edit*/) const override { return under_way() < window; }
  TimeUs wait_us(const EditDescriptor& /*edit*/, TimeUs /*now_us*/) override { return wait; }
  Result<ClientSequence, std::string> offer(const EditDescriptor& edit, const InAction& in_action,
                                            TimeUs /*now_us*/) override {
    if (refusal) return failure(*std::exchange(refusal, std::nullopt));
    const ClientSequence seq = ++last;
    offered[seq] = {edit, in_action.action == kBeginsAction ? seq : in_action.action, false};
    is_optional = is_optional && in_action.is_optional;
    has_sender = has_sender && in_action.has_sender;
    return seq;
  }
  bool is_answered(ClientSequence seq) const override { return offered.at(seq).is_answered; }

  std::size_t under_way() const {
    std::size_t count = 0;
    for (const auto& [seq, edit] : offered) count += edit.is_answered ? 0 : 1;
    return count;
  }
  void apply(ClientSequence seq) {
    REQUIRE_FALSE(offered.at(seq).is_answered);
    offered.at(seq).is_answered = true;
    applied.push_back(seq);
  }
  void apply_all() {
    for (auto& [seq, edit] : offered) {
      if (!edit.is_answered) apply(seq);
    }
  }
  /// Marks the edit as answered and returns its rejection.
  RejectedEdit reject(ClientSequence seq, RejectReason reason, std::string detail = {}) {
    REQUIRE_FALSE(offered.at(seq).is_answered);
    offered.at(seq).is_answered = true;
    return {seq, reason, std::move(detail)};
  }
  /// Returns the actions of the applied edits.
  std::set<ClientSequence> actions() const {
    std::set<ClientSequence> out;
    for (const ClientSequence seq : applied) out.insert(offered.at(seq).action);
    return out;
  }

  std::map<ClientSequence, Offered> offered;
  std::vector<ClientSequence> applied;
  ClientSequence last = 10;
  bool is_optional = true, has_sender = true;  // of all edits
};

/// A source of steps that the test lists.
class ListSource final : public EditSource {
 public:
  explicit ListSource(std::vector<SourceStep> steps) : steps_(steps.begin(), steps.end()) {}
  SourceStep next() override {
    if (steps_.empty()) return SourceStep::done();
    SourceStep step = steps_.front();
    steps_.pop_front();
    return step;
  }
  std::uint64_t voxels() const override { return 100; }

 private:
  std::deque<SourceStep> steps_;
};

inline SourceStep voxel_step(std::int32_t x) {
  return SourceStep::of({SetVoxel{{x, 0, 0}}, {}, 1});
}
inline std::unique_ptr<EditSource> voxels_of(std::int32_t count) {
  std::vector<SourceStep> steps;
  for (std::int32_t x = 0; x < count; ++x) steps.push_back(voxel_step(x));
  return std::make_unique<ListSource>(std::move(steps));
}

}  // namespace runstone::test
