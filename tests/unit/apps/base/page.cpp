#include "apps/base/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

using testing::HasSubstr;

TEST(HtmlEscape, LeavesNoMarkup) {
  EXPECT_EQ(html_escape(R"(<a href="x" id='y'>&amp;</a>)"),
            "&lt;a href=&quot;x&quot; id=&#39;y&#39;&gt;&amp;amp;&lt;/a&gt;");
  EXPECT_EQ(html_escape("µ ≤ 0.07\n\t"), "µ ≤ 0.07\n\t");
}

TEST(ValidText, ReplacesWhatIsNoText) {
  const std::string sign = "\xEF\xBF\xBD";
  EXPECT_EQ(valid_text(std::string("a\0b\x1b", 4)), "a" + sign + "b" + sign);
  EXPECT_EQ(valid_text("\xff"), sign);
  EXPECT_EQ(valid_text("\xc3"), sign) << "cut off";
  EXPECT_EQ(valid_text("\xc0\xaf"), sign + sign) << "overlong";
  EXPECT_EQ(valid_text("\xed\xa0\x80"), sign + sign + sign) << "surrogate";
  EXPECT_EQ(valid_text("\xf4\x90\x80\x80"), sign + sign + sign + sign) << "past the last character";
  EXPECT_EQ(valid_text("é€𝄞"), "é€𝄞");
}

// RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(DataUri, HoldsTheFile) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.png") << "foo";
  std::ofstream(folder / "a.svg") << "foo";
  EXPECT_EQ(data_uri(folder / "a.png"), "data:image/png;base64,Zm9v");
  EXPECT_EQ(data_uri(folder / "a.svg"), "data:image/svg+xml;base64,Zm9v");
  EXPECT_THROW(data_uri(folder / "none.png"), std::runtime_error);
}

TEST(HtmlPage, IsOneWholePage) {
  const std::string page = html_page("a <b>", "<p>text</p>", "<script>1</script>");
  EXPECT_THAT(page, testing::StartsWith("<!doctype html>"));
  EXPECT_THAT(page, HasSubstr("<title>a &lt;b&gt;</title>"));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme: dark"));
  EXPECT_THAT(page, HasSubstr("@media print"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_LT(page.find("<p>text</p>"), page.find("<script>1</script>"));
}

}  // namespace
}  // namespace myowave::apps
