// The edit record whose bytes and checksum are pinned.
#pragma once
#include "common/edits/descriptor/edit_record.hpp"

namespace runstone::test {

inline EditRecord pinned_record() {
  EditRecord record;
  record.version = {2, 300};
  record.op = {7, 0x0123456789abcdefULL, 5};
  record.time_us = 1'700'000'000'000'000;
  record.cause = Cause::rollback;
  record.edit = {FillSphere{{0, 64, -64}, 3}, {MaskKind::only_solid, 0}, 7};
  record.subject = 299;
  record.log = 1;
  return record;
}

}  // namespace runstone::test
