#include "protocol/codec/password_key.hpp"

#include <sodium.h>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "common/names/normal_form.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kPasses = 3;
constexpr std::size_t kMemoryBytes = std::size_t{64} << 20;
static_assert(kPasswordSaltBytes == crypto_pwhash_argon2id_SALTBYTES);
static_assert(kPasswordHashBytes == crypto_generichash_BYTES);

}  // namespace

Result<PasswordKey, std::string> password_key(std::string_view password, const PasswordSalt& salt) {
  RUNSTONE_ASSERT(sodium_init() >= 0);
  if (password.empty() || password.size() > kPasswordBytesMax || !is_printable_utf8(password))
    return failure("a password is one line of 1 to " + std::to_string(kPasswordBytesMax) +
                   " bytes of printable UTF-8");
  const std::string text = nfc_of(password);
  PasswordKey key{};
  const int done = crypto_pwhash(key.data(), key.size(), text.data(), text.size(), salt.data(),
                                 kPasses, kMemoryBytes, crypto_pwhash_ALG_ARGON2ID13);
  if (done != 0) return failure("there is too little memory to compute the password's key");
  return key;
}

Result<JoinPassword, std::string> join_password(std::string_view password, const PasswordSalt& salt,
                                                const std::string& role) {
  if (is_printable_utf8(password) && character_count(nfc_of(password)) < kPasswordCharactersMin)
    return failure("the password has fewer than " + std::to_string(kPasswordCharactersMin) +
                   " characters: take some words");
  const auto key = password_key(password, salt);
  if (!key) return failure(key.error());
  return JoinPassword{role, salt, hash_of(*key)};
}

PasswordHash hash_of(const PasswordKey& key) {
  PasswordHash hash{};
  crypto_generichash(hash.data(), hash.size(), key.data(), key.size(), nullptr, 0);
  return hash;
}

bool is_key_of(const JoinPassword& password, const PasswordKey& key) {
  const PasswordHash hash = hash_of(key);
  return sodium_memcmp(hash.data(), password.hash.data(), hash.size()) == 0;
}

}  // namespace runstone
