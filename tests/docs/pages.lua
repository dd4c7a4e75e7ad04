-- The pages of the documentation as the tests of this folder read them: text without fenced code, code blocks, links,
-- anchors. A page is { path, text, prose, code = { { language, text, line } }, anchors = { name = true } }.
local cdem = require "cdem"

local root = cdem.parameter{ name = "root", default = ".", doc = "the checkout" }
local program = cdem.parameter{ name = "program", default = "cdem", doc = "the program" }
local scratch = cdem.parameter{ name = "scratch", default = ".", doc = "a folder for snippets" }

local pages = { root = root, program = program, scratch = scratch, problems = {} }

function pages.read(path)
  local file = io.open(path, "rb")
  if not file then return nil end
  local text = file:read "a"
  file:close()
  return text
end

function pages.list(pattern) -- files below the root, by find's -path
  local out, pipe = {}, io.popen(("cd '%s' && find . -path ./build -prune -o -path ./results -prune -o -path ./.git -prune"
    .. " -o -path '%s' -print | sort"):format(root, pattern))
  for line in pipe:lines() do out[#out + 1] = line:sub(3) end
  pipe:close()
  return out
end

function pages.complain(path, line, text)
  pages.problems[#pages.problems + 1] = line and ("%s:%d: %s"):format(path, line, text) or path .. ": " .. text
end

-- The anchor of a heading as python-markdown makes it, which is a forge's too unless blanks or dots meet.
function pages.anchor(heading)
  local words = heading:gsub("%[([^%]]*)%]%b()", "%1"):gsub("[`*]", "")
  words = words:gsub("[^%w%s_-]", ""):gsub("^%s+", ""):gsub("%s+$", ""):lower()
  return (words:gsub("[-%s]+", "-"))
end

-- Splits a page; code blocks are fenced, or indented by four blanks behind an empty line.
local function parse(path)
  local page = { path = path, text = pages.read(root .. "/" .. path), code = {}, anchors = {}, lines = {} }
  local fence, block, empty_before, number = nil, nil, true, 0
  for line in (page.text .. "\n"):gmatch "(.-)\n" do
    number = number + 1
    local mark, language = line:match "^(```+)(%w*)"
    if fence then
      if mark == fence then fence, block = nil, nil else block.text = block.text .. line .. "\n" end
      line = ""
    elseif mark then
      fence, block = mark, { language = language, text = "", line = number + 1 }
      page.code[#page.code + 1] = block
      line = ""
    elseif line:match "^    " and (block or empty_before) then
      if not block then
        block = { language = "indented", text = "", line = number }
        page.code[#page.code + 1] = block
      end
      block.text = block.text .. line:sub(5) .. "\n"
      line = ""
    elseif line:match "%S" then
      block = nil
      local heading = line:match "^#+%s+(.*)"
      if heading then page.anchors[pages.anchor(heading)] = true end
    end
    empty_before = not line:match "%S"
    page.lines[number] = line
  end
  page.prose = table.concat(page.lines, "\n")
  return page
end

function pages.all()
  local out = {}
  for _, path in ipairs(pages.list "./*.md") do
    if not path:match "^tests/" then out[#out + 1] = parse(path) end
  end
  return out
end

function pages.line_of(page, position) -- of a position in the prose
  local _, count = page.prose:sub(1, position):gsub("\n", "")
  return count + 1
end

-- Ends the test: one line a problem, and exit code 2 when there is one.
function pages.finish(looked_at)
  for _, problem in ipairs(pages.problems) do io.stderr:write(problem, "\n") end
  cdem.log(("%d looked at, %d wrong"):format(looked_at, #pages.problems))
  if looked_at == 0 then error("nothing was looked at", 0) end
  if #pages.problems > 0 then error(#pages.problems .. " problems in the pages", 0) end
end

return pages
