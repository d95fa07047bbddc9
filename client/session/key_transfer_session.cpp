#include "client/session/key_transfer_session.hpp"

#include <utility>

#include "protocol/codec/key_fingerprint.hpp"
#include "protocol/codec/message_table.hpp"

namespace runstone {

KeyTransferSession::KeyTransferSession(const KeyPair& keys, std::map<WorldId, PublicKey> pinned,
                                       Request request)
    : request_(std::move(request)) {
  config_.keys = keys;
  config_.pinned = std::move(pinned);
  config_.features = kFeatureKeyTransfer;
  config_.name = key_fingerprint(keys.public_key);  // nobody else owns such a name
}

void KeyTransferSession::connected(const Nonce& nonce,
                                   const std::optional<ChannelBinding>& binding) {
  hello_ = make_hello(config_, nonce);
  binding_ = binding;
  outgoing_.push_back(hello_);
}

void KeyTransferSession::receive(const Message& message) {
  if (outcome_) return;
  if (const auto* goodbye = std::get_if<Goodbye>(&message))
    return fail("the server refused: " + goodbye->text);
  const SessionStage stage = welcome_ ? SessionStage::authenticating : SessionStage::greeting;
  if (const auto refusal =
          refusal_of(info_of(message), Sender::server, stage, welcome_ ? welcome_->features : 0))
    return fail(std::string("the server broke the protocol: ") + refusal->text);
  if (const auto* welcome = std::get_if<Welcome>(&message)) return on_welcome(*welcome);
  const bool is_deposit = std::holds_alternative<KeyDeposit>(request_);
  const auto* deposited = std::get_if<KeyDeposited>(&message);
  const auto* sealed = std::get_if<SealedKey>(&message);
  if (is_deposit && deposited != nullptr) {
    if (deposited->seconds == 0) return fail("the server refused: " + deposited->text);
    outcome_ = Result<Answer, std::string>(*deposited);
  } else if (!is_deposit && sealed != nullptr) {
    outcome_ = Result<Answer, std::string>(*sealed);
  } else {
    fail("the server sent an unexpected message");
  }
}

void KeyTransferSession::on_welcome(const Welcome& welcome) {
  if (const auto fault = check_welcome(hello_, welcome, binding_, config_.pinned))
    return fail(fault->text);
  if ((welcome.features & kFeatureKeyTransfer) == 0)
    return fail("the server passes no keys to other devices");
  welcome_ = welcome;
  if (auto* deposit = std::get_if<KeyDeposit>(&request_)) {
    deposit->signature = sign(config_.keys, client_transcript(hello_, welcome, binding_));
    outgoing_.push_back(*deposit);
  } else {
    outgoing_.push_back(std::get<KeyRequest>(request_));
  }
}

void KeyTransferSession::disconnected(const std::string& why) {
  if (!outcome_) fail(why);
}

void KeyTransferSession::fail(std::string why) {
  outcome_ = Result<Answer, std::string>(failure(std::move(why)));
}

}  // namespace runstone
