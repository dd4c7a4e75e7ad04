-- The Lua pieces of a tutorial, typed one after the other, make a script that `cdem check` accepts; data files that the page
-- links lie beside it.
local pages = require "pages"

local function save(name, text)
  local file <close> = assert(io.open(pages.scratch .. "/" .. name, "wb"))
  file:write(text)
end

local count = 0
for _, page in ipairs(pages.all()) do
  local name = page.path:match "^docs/tutorials/([%w_]+)%.md$"
  if name then
    count = count + 1
    local pieces = {}
    for _, block in ipairs(page.code) do
      if block.language == "lua" then pieces[#pieces + 1] = block.text end
    end
    for path in page.text:gmatch "%(%.%./%.%./([%w_/]+%.csv)%)" do
      save(path:match "[^/]+$", assert(pages.read(pages.root .. "/" .. path), path))
    end
    save("tutorial_" .. name .. ".lua", table.concat(pieces))
    local pipe = io.popen(("'%s' check '%s/tutorial_%s.lua' --threads 1 2>&1"):format(pages.program, pages.scratch, name))
    local said = pipe:read "a"
    if not pipe:close() then pages.complain(page.path, nil, "cdem check: " .. said) end
  end
end
pages.finish(count)
