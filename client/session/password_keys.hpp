// PasswordKeys: makes the keys of a password that the user gave. A key takes a quarter of a second,
// so the last one is kept: reconnections, and the sessions of a fleet that share the object,
// compute it once. Thread: one.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "protocol/codec/password_key.hpp"

namespace runstone {

class PasswordKeys {
 public:
  explicit PasswordKeys(std::string password) : password_(std::move(password)) {}

  /// Returns the key for a world with this salt. Fails as password_key().
  Result<PasswordKey, std::string> key_for(const PasswordSalt& salt) {
    if (last_ && last_->first == salt) return last_->second;
    auto key = password_key(password_, salt);
    if (key) last_.emplace(salt, *key);
    return key;
  }

 private:
  const std::string password_;
  std::optional<std::pair<PasswordSalt, PasswordKey>> last_;
};

}  // namespace runstone
