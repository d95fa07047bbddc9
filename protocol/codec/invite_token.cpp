#include "protocol/codec/invite_token.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>

namespace runstone {
namespace {

constexpr std::size_t kInviteIdBytes = sizeof(InviteId);
using TokenBytes = std::array<std::uint8_t, kInviteIdBytes + kSignatureBytes>;
static_assert(sodium_base64_ENCODED_LEN(sizeof(TokenBytes),
                                        sodium_base64_VARIANT_URLSAFE_NO_PADDING) ==
              kInviteTokenBytes + 1);

Bytes signed_bytes(InviteId invite, const WorldId& world) {
  constexpr std::string_view kLabel = "runstone invite v1";
  Bytes out(kLabel.begin(), kLabel.end());
  ByteWriter w(out);
  w.bytes(world);
  w.u64(invite);
  return out;
}

}  // namespace

std::string invite_token(InviteId invite, const WorldId& world, const KeyPair& server) {
  Bytes bytes;
  ByteWriter w(bytes);
  w.u64(invite);
  w.bytes(sign(server, signed_bytes(invite, world)));
  std::array<char, kInviteTokenBytes + 1> text{};
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(),
                    sodium_base64_VARIANT_URLSAFE_NO_PADDING);
  return text.data();
}

std::optional<InviteId> invite_of(std::string_view token, const WorldId& world,
                                  const PublicKey& server) {
  if (token.size() != kInviteTokenBytes) return std::nullopt;
  TokenBytes bytes{};
  std::size_t size = 0;
  if (sodium_base642bin(bytes.data(), bytes.size(), token.data(), token.size(), nullptr, &size,
                        nullptr, sodium_base64_VARIANT_URLSAFE_NO_PADDING) != 0 ||
      size != bytes.size())
    return std::nullopt;
  ByteReader r(bytes);
  const InviteId invite = r.u64();
  Signature signature{};
  const ByteView rest = r.bytes(kSignatureBytes);
  std::copy(rest.begin(), rest.end(), signature.begin());
  if (!verify(server, signed_bytes(invite, world), signature)) return std::nullopt;
  return invite;
}

}  // namespace runstone
