#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"

namespace nepho::test {

// `action` is refused in one message that holds all the parts, and no library writes a word.
template <class Action>
void expect_quiet_refusal(Action&& action, const std::vector<std::string>& parts) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::string text;
  try {
    action();
  } catch (const Error& e) {
    text = e.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
}

}  // namespace nepho::test
