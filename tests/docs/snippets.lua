-- Every Lua snippet compiles, calls functions that there are with the fields they have, and is accepted by `cdem check`
-- when it is a whole script: one that requires cdem, and reads no file of the user's.
local declared = require "declared"
local pages = require "pages"

local count = 0
for _, page in ipairs(pages.all()) do
  for _, block in ipairs(page.code) do
    if block.language == "lua" then
      count = count + 1
      -- "..." stands for what is left out: a value in a table, a statement of its own.
      local text = block.text:gsub("\n%s*%.%.%.%s*\n", "\n\n"):gsub("^%s*%.%.%.%s*\n", "\n")
      local whole = text:match 'require "cdem"'
      local compiled, why = load(text, "=" .. page.path, "t")
      if not compiled then
        compiled = load("return {" .. text .. "}", "=" .. page.path, "t") -- fields alone
      end
      if not compiled then pages.complain(page.path, block.line, why) end
      for _, problem in ipairs(declared.problems(text)) do
        pages.complain(page.path, block.line + problem.line - 1, problem.text)
      end
      if whole and compiled then
        local name = ("snippet_%d.lua"):format(count)
        local file <close> = assert(io.open(pages.scratch .. "/" .. name, "w"))
        file:write(text)
        file:flush()
        local pipe = io.popen(("'%s' check '%s/%s' --threads 1 2>&1"):format(pages.program, pages.scratch, name))
        local said = pipe:read "a"
        if not pipe:close() then pages.complain(page.path, block.line, "cdem check: " .. said) end
      end
    end
  end
end
pages.finish(count)
