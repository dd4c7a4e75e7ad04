-- Tests that pages name are there: `[tag]`, and the words behind `./cdem test -R` and `-L`.
local pages = require "pages"

local tags, names, labels = {}, {}, { examples = true, launcher = true, house = true, docs = true }
for _, path in ipairs(pages.list "./tests/*.cpp") do
  local text = pages.read(pages.root .. "/" .. path):gsub('"\n%s*"', "")
  for name in text:gmatch 'TEST_CASE%(%s*"([^"]*)"' do names[#names + 1] = name end
  for list in text:gmatch 'TEST_CASE%(%s*"[^"]*",%s*"([^"]*)"' do
    for tag in list:gmatch "%[([^%]]+)%]" do tags[tag] = true end
  end
end
for _, path in ipairs(pages.list "./tests/examples/*.lua") do
  names[#names + 1] = "examples." .. path:match "([^/]*)%.lua$"
end
for _, path in ipairs(pages.list "./tests/*CMakeLists.txt") do
  local text = pages.read(pages.root .. "/" .. path)
  for label in text:gmatch "LABELS%s+\"?([%w_;]+)" do
    for one in label:gmatch "[^;]+" do labels[one] = true end
  end
end

local function there_is(words) -- the words of -R, where . is any character
  local pattern = words:gsub("[%^%$%(%)%%%[%]%*%+%-%?]", "%%%0")
  for _, name in ipairs(names) do
    if name:find(pattern) then return true end
  end
  return false
end

local count = 0
for _, page in ipairs(pages.all()) do
  local text = page.text
  for position, tag in text:gmatch "()`%[([%l_]+)%]`" do
    count = count + 1
    if not tags[tag] then
      local _, line = text:sub(1, position):gsub("\n", "")
      pages.complain(page.path, line + 1, "no test has the tag [" .. tag .. "]")
    end
  end
  for position, flag, quoted, plain in text:gmatch "()cdem test %-([RL]) ('?)([^\n`|]+)" do
    count = count + 1
    local words = quoted == "'" and plain:match "^([^']*)'" or plain:match "^[%w_.]+"
    local fine = flag == "L" and labels[words] or flag == "R" and there_is(words)
    if not fine then
      local _, line = text:sub(1, position):gsub("\n", "")
      pages.complain(page.path, line + 1, "no test for -" .. flag .. " " .. tostring(words))
    end
  end
end
pages.finish(count)
