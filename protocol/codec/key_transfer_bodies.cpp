#include "protocol/codec/body_reader.hpp"

namespace runstone {
namespace {

bool take_sealed(const ByteField* from, Bytes& to) {
  const ByteView bytes = view_of(from);
  if (bytes.empty() || bytes.size() > kSealedKeyBytesMax) return false;
  to.assign(bytes.begin(), bytes.end());
  return true;
}

}  // namespace

Result<Message> BodyReader::read(const wire::KeyRequest& t) const {
  KeyRequest m;
  if (!take_exact(t.slot(), m.slot)) return bad("key_request.slot is not 16 bytes");
  return m;
}

Result<Message> BodyReader::read(const wire::SealedKey& t) const {
  SealedKey m;
  if (!take_sealed(t.sealed(), m.sealed)) return bad("sealed_key.sealed is not 1 .. 512 bytes");
  return m;
}

Result<Message> BodyReader::read(const wire::KeyDeposit& t) const {
  KeyDeposit m;
  if (!take_exact(t.slot(), m.slot)) return bad("key_deposit.slot is not 16 bytes");
  if (!take_sealed(t.sealed(), m.sealed)) return bad("key_deposit.sealed is not 1 .. 512 bytes");
  if (!take_exact(t.signature(), m.signature)) return bad("key_deposit.signature is not 64 bytes");
  return m;
}

Result<Message> BodyReader::read(const wire::KeyDeposited& t) const {
  KeyDeposited m;
  m.seconds = t.seconds();
  if (!take_text(t.text(), 0, kTextBytesMax, m.text))
    return bad("key_deposited.text is not 0 .. 256 bytes of text");
  return m;
}

}  // namespace runstone
