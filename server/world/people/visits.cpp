#include "server/world/people/visits.hpp"

namespace runstone {

void Visits::say(const PublicKey& key, const std::string& line, const Clocks& now) {
  if (lines_.take(1, now.steady_us)) chat_.tell_of_visit(key, line, now);
}

void Visits::joined(const Session& session, bool goes_on, const Clocks& now) {
  const auto [found, is_new] = visitors_.try_emplace(session.key);
  Visitor& visitor = found->second;
  if (!is_new && visitor.sessions == 0) --gone_;
  visitor.name = session.name;
  visitor.gone_us.reset();
  ++visitor.sessions;
  if (is_new && !goes_on) say(session.key, session.name + " has joined", now);
}

void Visits::left(const Session& session) {
  const auto found = visitors_.find(session.key);
  if (found == visitors_.end() || found->second.sessions == 0) return;
  if (--found->second.sessions == 0) ++gone_;
}

void Visits::tick(const Clocks& now) {
  if (gone_ == 0) return;
  for (auto it = visitors_.begin(); it != visitors_.end();) {
    Visitor& visitor = it->second;
    if (visitor.sessions == 0 && !visitor.gone_us) visitor.gone_us = now.steady_us;
    if (visitor.sessions != 0 || now.steady_us - *visitor.gone_us < kVisitPauseUs) {
      ++it;
      continue;
    }
    say(it->first, visitor.name + " has left", now);
    it = visitors_.erase(it);
    --gone_;
  }
}

void Visits::begin_anew() {
  visitors_.clear();
  gone_ = 0;
  for (const Session* session : sessions_.open()) {
    Visitor& visitor = visitors_[session->key];
    visitor.name = session->name;
    ++visitor.sessions;
  }
}

}  // namespace runstone
