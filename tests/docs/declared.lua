-- The declarations (`cdem annotations`), and where a snippet says otherwise: functions and
-- methods that there are not, and fields that they do not take.
local pages = require "pages"

local declared = { functions = {}, methods = {}, classes = {} }

local class, taken
local annotations = assert(io.popen(("'%s' annotations"):format(pages.program)))
for line in annotations:lines() do
  local name = line:match "^%-%-%-@class %(exact%) cdem%.(%w+)"
  if name then
    class = {}
    declared.classes[name] = class
  end
  local field, type = line:match "^%-%-%-@field ([%w_]+)%?? (%S+)"
  if field and class then class[field] = type end
  taken = line:match "^%-%-%-@param options%?? cdem%.(%w+)" or taken
  local owner, mark, called = line:match "^function ([%w_.]-)([.:])([%w_]+)%("
  if owner then
    if mark == ":" then
      declared.methods[called] = declared.methods[called] or {}
      table.insert(declared.methods[called], taken or false)
    else
      declared.functions[(owner .. "." .. called):match "^cdem%.(.*)"] = taken or false
    end
    taken = nil
  end
end
assert(annotations:close(), "cdem annotations failed")
assert(next(declared.functions) and next(declared.methods))

-- The text with the insides of comments and strings blanked, so that only code is left; lines stay where they are.
local function bare(text)
  local function blank(s) return (s:gsub("[^\n]", " ")) end
  text = text:gsub("%-%-%[%[.-%]%]", blank)
  local out, i = {}, 1
  while i <= #text do
    local c = text:sub(i, i)
    local stop
    if c == '"' or c == "'" then
      stop = i + 1
      while stop < #text and text:sub(stop, stop) ~= c do stop = stop + (text:sub(stop, stop) == "\\" and 2 or 1) end
      out[#out + 1] = c .. blank(text:sub(i + 1, stop - 1)) .. c
    elseif text:sub(i, i + 1) == "--" then
      stop = (text:find("\n", i, true) or #text + 1) - 1
      out[#out + 1] = blank(text:sub(i, stop))
    else
      stop = i
      out[#out + 1] = c
    end
    i = stop + 1
  end
  return table.concat(out)
end

-- The names of a table's own fields: "name =" at its first level. `inside` is what stands between its braces.
local function fields_of(inside)
  local out, depth = {}, 0
  local i = 1
  while i <= #inside do
    local c = inside:sub(i, i)
    if c:match "[%[({]" then depth = depth + 1 elseif c:match "[%])}]" then depth = depth - 1 end
    local word = c:match "[%a_]" and inside:match("^[%w_]+", i)
    if word == "function" then -- its body is no table of ours
      local level, j = 1, i + #word
      while level > 0 and j <= #inside do
        local inner = inside:match("^[%a_][%w_]*", j)
        if inner == "end" then level = level - 1
        elseif inner == "function" or inner == "do" or inner == "then" then level = level + 1 end
        if inner == "elseif" then level = level - 1 end
        j = j + #(inner or " ")
      end
      i = j
    elseif word then
      local behind = inside:match("^%s*=[^=]", i + #word)
      if depth == 0 and behind then out[#out + 1] = { name = word, at = i, value_at = i + #word + #behind - 1 } end
      i = i + #word
    else
      i = i + 1
    end
  end
  return out
end

local function check_table(code, brace, class_name, called, complain)
  local fields = declared.classes[class_name]
  local inside = code:match("^%b{}", brace)
  if not fields or not inside then return end
  for _, field in ipairs(fields_of(inside:sub(2, -2))) do
    local type = fields[field.name]
    if not type then
      complain(brace + field.at, called .. " has no field '" .. field.name .. "'")
    else
      local inner, list = type:match "^cdem%.(%w+)(%[?%]?)"
      local value = inside:match("^%s*()%b{}", field.value_at + 1)
      if inner and value and declared.classes[inner] then
        if list == "[]" then
          for at in inside:sub(value + 1, value + #inside:match("^%b{}", value) - 2):gmatch "()%b{}" do
            check_table(code, brace + value + at - 1, inner, called .. "." .. field.name, complain)
          end
        else
          check_table(code, brace + value - 1, inner, called .. "." .. field.name, complain)
        end
      end
    end
  end
end

function declared.problems(text)
  local code, out = bare(text), {}
  local function complain(at, what)
    local _, lines = code:sub(1, at):gsub("\n", "")
    out[#out + 1] = { line = lines + 1, text = what }
  end
  for at, name, brace in code:gmatch "()%f[%w_]cdem%.([%a_][%w_.]*)%s*()" do
    local options = declared.functions[name]
    if options == nil and name ~= "version" then complain(at, "there is no cdem." .. name) end
    if options and code:sub(brace, brace) == "{" then check_table(code, brace, options, "cdem." .. name, complain) end
  end
  for at, name, brace in code:gmatch "():([%a_][%w_]*)%s*()[{]" do
    local candidates = declared.methods[name]
    if not candidates then
      complain(at, "nothing has a method '" .. name .. "' with a table")
    else -- the class of the value is not known: one of them must take the fields
      local best
      for _, options in ipairs(candidates) do
        local found = {}
        if options then
          check_table(code, brace, options, ":" .. name, function(where, what) found[#found + 1] = { where, what } end)
        end
        if not best or #found < #best then best = found end
      end
      for _, problem in ipairs(best) do complain(problem[1], problem[2]) end
    end
  end
  return out
end

return declared
