// MapAnswer: the answer to a request of the map, in the terms of HTTP.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

namespace runstone {

struct MapAnswer {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;  // null: empty
  std::string etag;                         // of a picture; empty: none
  std::uint64_t work_us = 0;                // time of the worker
};

/// Returns an answer that is one sentence.
MapAnswer map_words(unsigned status, const std::string& sentence);

}  // namespace runstone
