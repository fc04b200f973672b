// Version and git revision of the program. A commit changes them, and only revision.cpp is compiled again for
// it.
#pragma once

namespace myowave::apps {

// "0.1.0"
const char* version();

// 12 hexadecimal digits of the commit; "unknown" outside of a git checkout.
const char* git_revision();

// Whether tracked files differed from that commit.
bool has_local_changes();

}  // namespace myowave::apps
