// The receiving end of a framed byte stream: keeps bytes until a frame is whole and drops them one by one when they are
// not part of any. The search goes on one byte after a false start, so a good frame behind garbage is never lost.
#pragma once

#include <cstddef>

#include "protocols/serial/bytes.hpp"

namespace serial {

class FrameBuffer {
 public:
  // What stands at the front of the buffer, as the protocol sees it.
  struct Verdict {
    enum Kind { incomplete, frame, bad_checksum, not_a_frame } kind = incomplete;
    std::size_t size = 0;  // of the frame
  };

  void feed(ByteSpan bytes) {
    if (bytes.empty()) return;
    silent_ = false;
    if (begin_ > 0) {
      bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
      begin_ = 0;
    }
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  // The next good frame, or an empty span when more bytes are needed. It stays valid until the next feed().
  template <typename Judge>
  ByteSpan next(const Judge& judge) {
    while (begin_ < bytes_.size()) {
      const ByteSpan waiting = ByteSpan(bytes_).subspan(begin_);
      const Verdict verdict = judge(waiting);
      if (verdict.kind == Verdict::incomplete && !silent_) return {};
      if (verdict.kind == Verdict::frame) {
        begin_ += verdict.size;
        ++counts_.frames;
        return waiting.first(verdict.size);
      }
      if (verdict.kind == Verdict::bad_checksum) ++counts_.bad_checksums;
      ++begin_;
      ++counts_.skipped_bytes;
    }
    return {};
  }

  // The sender paused in the middle: what looked like the start of a long frame was none. Call next() afterwards.
  void line_fell_silent() { silent_ = true; }

  const FrameCounts& counts() const { return counts_; }
  FrameCounts& counts() { return counts_; }

 private:
  Bytes bytes_;
  std::size_t begin_ = 0;
  bool silent_ = false;
  FrameCounts counts_;
};

}  // namespace serial
