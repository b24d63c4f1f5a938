#pragma once

namespace orchard::apps {

inline constexpr double kMebibyte = 1048576;  // bytes

}  // namespace orchard::apps
