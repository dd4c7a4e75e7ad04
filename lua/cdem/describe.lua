-- cdem.describe: any value as readable text; what the repl prints.
local cdem = ...

local longest_line = 100

local function is_name(text) return text:match("^[%a_][%w_]*$") ~= nil end

local function describe(value, indent, seen)
  if type(value) == "string" then return string.format("%q", value) end
  if type(value) ~= "table" then return tostring(value) end
  if seen[value] then return "{...}" end
  seen[value] = true
  local parts = {}
  for i = 1, #value do parts[i] = describe(value[i], indent .. "  ", seen) end
  for key, entry in pairs(value) do
    if not (math.type(key) == "integer" and key >= 1 and key <= #value) then
      local name = type(key) == "string" and is_name(key) and key or "[" .. describe(key, "", seen) .. "]"
      parts[#parts + 1] = name .. " = " .. describe(entry, indent .. "  ", seen)
    end
  end
  seen[value] = nil
  local line = "{" .. table.concat(parts, ", ") .. "}"
  if #line + #indent <= longest_line then return line end
  return "{\n" .. indent .. "  " .. table.concat(parts, ",\n" .. indent .. "  ") .. "\n" .. indent .. "}"
end

function cdem.describe(value)
  if type(value) == "string" then return value end
  return describe(value, "", {})
end
