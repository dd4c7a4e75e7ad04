-- Commands that pages show are commands of the program or the launcher, with options and files that there are.
local pages = require "pages"

local function words_of(command) -- what `PROGRAM COMMAND --help` names as options
  local pipe = io.popen(("'%s' %s --help 2>&1"):format(pages.program, command))
  local said = pipe:read "a"
  pipe:close()
  return said
end

local help = { test = "", bench = "", docs = "", setup = "", help = "" } -- the launcher's own: their options are others'
for name in words_of(""):gmatch "\n  (%l+)  +%l" do help[name] = words_of(name) end
local launcher = pages.read(pages.root .. "/cdem")
for name in launcher:gmatch "\n  ([%l_]+)%)\n" do help[name] = help[name] or "" end

local count = 0
local function check(path, line, command)
  local name, rest = command:gsub("^%./", ""):match "^cdem%s+([%l]+)(.*)$"
  if not name then return end
  count = count + 1
  local options = help[name]
  if not options then return pages.complain(path, line, "there is no command '" .. name .. "': " .. command) end
  rest = rest:gsub("%s#.*", "")
  if options == "" then return end
  for option in rest:gmatch "%s(%-%-?[%a-]+)" do
    if not options:find("%f[%w-]" .. option:gsub("%-", "%%-") .. "%f[^%w-]") then
      pages.complain(path, line, name .. " has no option " .. option)
    end
  end
  local script = rest:match "examples/[%w_./-]+%.lua"
  local text = script and pages.read(pages.root .. "/" .. script)
  if script and not text then pages.complain(path, line, "there is no " .. script) end
  for setting in (text and rest or ""):gmatch "%-%-set%s+([%w_]+)=" do
    local folder, known = script:match "^(.*/)", false
    for _, file in ipairs(pages.list("./" .. folder .. "*.lua")) do -- a module of the script may ask for it
      if pages.read(pages.root .. "/" .. file):find('name = "' .. setting .. '"', 1, true) then known = true end
    end
    if not known then pages.complain(path, line, script .. " has no parameter " .. setting) end
  end
end

for _, page in ipairs(pages.all()) do
  for _, block in ipairs(page.code) do
    if block.language == "indented" or block.language == "sh" or block.language == "text" then
      local line = block.line
      for text in block.text:gmatch "(.-)\n" do
        check(page.path, line, text:match "^%s*(.*)")
        line = line + 1
      end
    end
  end
  for position, text in page.prose:gmatch "()`(%.?/?cdem [^`]+)`" do
    check(page.path, pages.line_of(page, position), (text:gsub("%s+", " ")))
  end
end
pages.finish(count)
