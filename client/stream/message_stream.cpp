#include "client/stream/message_stream.hpp"

#include <utility>

#include "protocol/codec/message_table.hpp"

namespace runstone {

Result<void> MessageStream::receive(ByteView bytes, TimeUs received_us) {
  return reader_.feed(bytes, [&](MessageKind kind, ByteView body) -> Result<void> {
    const FrameClass frame_class = info_of(kind).frame_class;
    const std::uint64_t frames =
        reader_.frames(frame_class) -
        std::exchange(frames_before_[static_cast<std::size_t>(frame_class)],
                      reader_.frames(frame_class));
    const auto taken = sink_.on_bytes(kind, body, chunk_edge_, received_us);
    if (!taken) return failure(taken.error());
    if (*taken) {
      stats_.received.add(kind, body.size(), frames);
      return {};
    }
    const std::int64_t start_ns = clock_();
    auto message = decode_message(Sender::server, kind, body, chunk_edge_);
    if (!message) return failure(message.error());
    const std::int64_t end_ns = clock_();
    stats_.received.add(kind, body.size(), frames);
    if (const auto* welcome = std::get_if<Welcome>(&*message)) {
      chunk_edge_ = welcome->chunk_edge;
      features_ = welcome->features;
    }
    LinkReceived received;
    received.connection = connection_;
    received.message = std::move(*message);
    received.bytes = body.size();
    received.received_us = received_us;
    received.unpacked_us = end_ns / 1000;
    received.unpack_ns = end_ns - start_ns;
    sink_.on_received(std::move(received));
    return {};
  });
}

std::optional<TimeUs> MessageStream::acknowledge(TimeUs now_us) {
  if ((features_ & kFeatureReceiveAck) == 0) return std::nullopt;
  const std::uint64_t total = reader_.frame_bytes(FrameClass::chunks);
  if (receive_acks_.is_due(total, now_us)) {
    receive_acks_.sent(total, now_us);
    static_cast<void>(queue(encode_message(ReceiveAck{total})));
  }
  return receive_acks_.due(total);
}

bool MessageStream::queue(const EncodedMessage& message) {
  queued_bytes_ += message.bytes->size();
  if (queued_bytes_ > kSendBytesMax) return false;
  (class_of(message) == FrameClass::edits ? edits_ : others_).push_back(message);
  return true;
}

void MessageStream::write(Bytes& out, std::size_t bytes_max) {
  while (out.size() < bytes_max && has_output()) {
    auto& queue = edits_.empty() ? others_ : edits_;
    const EncodedMessage& message = queue.front();
    const std::size_t bytes = message.bytes->size();
    writer_.append(message, out);
    stats_.sent.add(message.kind, bytes, (bytes + kFragmentBytesMax - 1) / kFragmentBytesMax);
    queued_bytes_ -= bytes;
    queue.pop_front();
  }
}

}  // namespace runstone
