// Writes C++ that compares the P/Invoke declarations of examples/csharp with runstone.h. It is compiled
// with these declarations. scripts/check-csharp gives what it writes to a compiler.
using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Text;
using Runstone;

internal static class Layouts {
  private static readonly Dictionary<Type, string> prefixes = new Dictionary<Type, string> {
    { typeof(Status), "RUNSTONE_" },
    { typeof(Mask), "RUNSTONE_MASK_" },
    { typeof(Pass), "RUNSTONE_PASS_" },
    { typeof(Order), "RUNSTONE_ORDER_" },
    { typeof(ClientState), "RUNSTONE_CLIENT_" },
    { typeof(EventKind), "RUNSTONE_EVENT_" },
  };
  private static readonly Dictionary<Type, string> scalars = new Dictionary<Type, string> {
    { typeof(byte), "std::uint8_t" },   { typeof(ushort), "std::uint16_t" },
    { typeof(int), "std::int32_t" },    { typeof(uint), "std::uint32_t" },
    { typeof(long), "std::int64_t" },   { typeof(ulong), "std::uint64_t" },
    { typeof(float), "float" },         { typeof(double), "double" },
    { typeof(UIntPtr), "std::size_t" }, { typeof(IntPtr), "AnyPointer" },
  };
  // Structs of the sample alone, whose bytes are an array in the header.
  private static readonly Type[] arrays = { typeof(Float2), typeof(Float3) };

  // Returns StructSize as struct_size.
  private static string Snake(string name) {
    var out_ = new StringBuilder();
    foreach (char each in name) {
      if (char.IsUpper(each) && out_.Length > 0) out_.Append('_');
      out_.Append(char.ToLowerInvariant(each));
    }
    return out_.ToString();
  }

  // Returns the type of C++ that has to stand in the header.
  private static string TypeOf(Type type) {
    if (type.IsByRef || type.IsArray) return TypeOf(type.GetElementType()) + "*";
    if (typeof(SafeHandle).IsAssignableFrom(type)) return "runstone_" + Snake(type.Name) + "*";
    if (type.IsEnum) return scalars[Enum.GetUnderlyingType(type)];
    string scalar;
    return scalars.TryGetValue(type, out scalar) ? scalar : "runstone_" + Snake(type.Name);
  }

  private static void WriteStruct(Type type) {
    string name = TypeOf(type);
    Console.WriteLine("static_assert(sizeof({0}) == {1});", name, Marshal.SizeOf(type));
    foreach (FieldInfo field in type.GetFields(BindingFlags.Public | BindingFlags.Instance)) {
      string member = Snake(field.Name);
      Console.WriteLine("static_assert(offsetof({0}, {1}) == {2});", name, member,
                        Marshal.OffsetOf(type, field.Name));
      var bytes = (MarshalAsAttribute)Attribute.GetCustomAttribute(field, typeof(MarshalAsAttribute));
      if (bytes != null) {
        Console.WriteLine("static_assert(sizeof({0}::{1}) == {2});", name, member, bytes.SizeConst);
      } else if (arrays.Contains(field.FieldType)) {
        Console.WriteLine("static_assert(sizeof({0}::{1}) == {2});", name, member,
                          Marshal.SizeOf(field.FieldType));
      } else {
        Console.WriteLine("static_assert(matches<decltype({0}::{1}), {2}>);", name, member,
                          TypeOf(field.FieldType));
      }
    }
  }

  private static int Main() {
    Console.WriteLine("#include \"tests/abi/csharp/matches.hpp\"");
    Type[] types = typeof(Native).Assembly.GetTypes().Where(each => each.Namespace == "Runstone").ToArray();
    foreach (Type type in types.Where(each => each.IsEnum)) {
      foreach (object value in Enum.GetValues(type)) {
        string name = Snake(Enum.GetName(type, value)).ToUpperInvariant();
        Console.WriteLine("static_assert({0}{1} == {2});", prefixes[type], name, Convert.ToInt64(value));
      }
    }
    foreach (Type type in types.Where(each => each.IsValueType && !each.IsEnum && !arrays.Contains(each)))
      WriteStruct(type);
    int functions = 0;
    foreach (MethodInfo method in typeof(Native).GetMethods(BindingFlags.Static | BindingFlags.NonPublic)) {
      if ((method.Attributes & MethodAttributes.PinvokeImpl) == 0) continue;
      string parameters = string.Join(
          "", method.GetParameters().Select(each => ", " + TypeOf(each.ParameterType)));
      Console.WriteLine("static_assert(is_called<decltype({0}), {1}{2}>);", method.Name,
                        TypeOf(method.ReturnType), parameters);
      Marshal.Prelink(method);  // throws if the library does not export it
      ++functions;
    }
    Console.Error.WriteLine("{0} functions", functions);
    return functions > 0 ? 0 : 1;
  }
}
