// What separates words in texts. Internal to io.
#pragma once

namespace gridmorph::io {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace gridmorph::io
