// A cdem that serves its page, as a browser on this machine meets it.
#pragma once

#include "tests/apps/support/child.hpp"

#include <future>

namespace testing {

class ServedPage {
public:
  struct File {
    std::string name, text;
  };
  // Writes the files, does `before` (none: ""), then starts `cdem arguments` among them and waits for its address.
  ServedPage(const std::vector<File>& files, const std::string& arguments, const std::string& before = "");
  ~ServedPage();
  ServedPage(const ServedPage&) = delete;
  ServedPage& operator=(const ServedPage&) = delete;

  // Sends the bytes as they are; the answer.
  std::string raw(const std::string& request) const;
  std::string ask(const std::string& what, const std::string& host = "", const std::string& more = "",
                  const std::string& method = "GET", const std::string& body = "") const;
  std::string here(const std::string& name) const { return "/" + token + "/" + name; }
  Outcome stop(); // by the page's button
  Outcome end();  // waits for it
  std::string said() const;
  const TempFolder& folder() const { return folder_; }

  int port = 0;
  std::string token, url;

private:
  TempFolder folder_;
  std::future<Outcome> ended_;
};

std::string first_line(const std::string& answer);

// Asks until the answer holds the text, at most 20 s.
std::string until(const ServedPage&, const std::string& what, const std::string& text);

} // namespace testing
