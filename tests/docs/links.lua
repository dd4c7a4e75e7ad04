-- Every relative link of a page leads to a file, its anchor to a heading there, and every picture has words.
local pages = require "pages"

local by_path, count = {}, 0
local all = pages.all()
for _, page in ipairs(all) do by_path[page.path] = page end

local function joined(folder, target) -- "docs/tutorials", "../theory.md" -> "docs/theory.md"
  local parts = {}
  for part in (folder .. "/" .. target):gmatch "[^/]+" do
    if part == ".." then table.remove(parts) elseif part ~= "." then parts[#parts + 1] = part end
  end
  return table.concat(parts, "/")
end

for _, page in ipairs(all) do
  local folder = page.path:match "^(.*)/[^/]*$" or ""
  for position, bang, words, target in page.prose:gmatch "()(!?)%[([^%[%]]*)%]%(([^%s)]+)%)" do
    count = count + 1
    local line = pages.line_of(page, position)
    if bang == "!" and not words:match "%S" then pages.complain(page.path, line, target .. ": a picture without words") end
    local file, anchor = target:match "^([^#]*)#?(.*)$"
    if not target:match "^%a+:" then
      local path = file == "" and page.path or joined(folder, file)
      local found = by_path[path]
      if not found and not pages.read(pages.root .. "/" .. path) then
        pages.complain(page.path, line, target .. ": no such file")
      elseif anchor ~= "" and not (found and found.anchors[anchor]) then
        pages.complain(page.path, line, target .. ": no such heading")
      end
    end
  end
  -- A picture inside a link: the pattern above sees the picture only.
  for position, target in page.prose:gmatch "()%]%(pictures/[^)]+%)%]%(([^%s)]+)%)" do
    count = count + 1
    if not pages.read(pages.root .. "/" .. joined(folder, target)) then
      pages.complain(page.path, pages.line_of(page, position), target .. ": no such file")
    end
  end
end
pages.finish(count)
