// The page of `cdem run --live`, from the files in live/page, which the build puts into the program.
#pragma once

namespace cdem::app {

extern const char* const page_html;
extern const char* const page_css;
extern const char* const page_js;

} // namespace cdem::app
