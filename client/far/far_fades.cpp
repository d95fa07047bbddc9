#include "client/far/far_fades.hpp"

namespace runstone {

bool FarFades::begin(const ChunkKey& key, bool is_coming) {
  if (fades_.size() >= kFadesMax && !fades_.contains(key)) return false;
  fades_[key] = {is_coming, std::nullopt, 0};
  return true;
}

std::vector<ChunkKey> FarFades::advance(double seconds) {
  std::vector<ChunkKey> ended;
  for (auto at = fades_.begin(); at != fades_.end();) {
    Fade& fade = at->second;
    if (!fade.begin) fade.begin = seconds;
    const double passed = seconds - *fade.begin;
    if (passed < 0 || passed >= kFadeSeconds) {
      ended.push_back(at->first);
      at = fades_.erase(at);
      continue;
    }
    fade.share = static_cast<float>(passed / kFadeSeconds);
    ++at;
  }
  return ended;
}

std::vector<ChunkKey> FarFades::keys() const {
  std::vector<ChunkKey> out;
  out.reserve(fades_.size());
  for (const auto& [key, fade] : fades_) out.push_back(key);
  return out;
}

const FarFades::Fade* FarFades::find(const ChunkKey& key) const {
  const auto found = fades_.find(key);
  return found == fades_.end() ? nullptr : &found->second;
}

bool FarFades::is_leaving(const ChunkKey& key) const {
  const Fade* fade = find(key);
  return fade != nullptr && !fade->is_coming;
}

bool FarFades::is_coming(const ChunkKey& key) const {
  const Fade* fade = find(key);
  return fade != nullptr && fade->is_coming;
}

float FarFades::octant_gone(const ChunkKey& key) const {
  const Fade* fade = find(key);
  if (fade == nullptr) return 0;
  return fade->is_coming ? fade->share : 1 - fade->share;
}

}  // namespace runstone
