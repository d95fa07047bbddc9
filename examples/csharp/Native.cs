// The functions and structs of runstone.h that this sample uses, as P/Invoke sees them. Names of
// structs and fields are those of the header in another spelling: StructSize is struct_size.
// scripts/check-csharp compares sizes, offsets, values and parameters with the header.
using System;
using System.Runtime.InteropServices;

namespace Runstone {

public enum Status {
  Ok = 0,
  NotFound = 10,
  BadHandle = 14,
  BufferTooSmall = 15,
  Unsupported = 19,
}
public enum Mask : uint { Everything = 0, OnlyEmpty = 1, OnlySolid = 2, OnlyMaterial = 3 }
public enum Pass : uint { Opaque = 0, Transparent = 1 }
public enum Order : uint { Xyz = 0, Xzy = 1, Yxz = 2, Yzx = 3, Zxy = 4, Zyx = 5 }
public enum ClientState : uint { Connecting = 0, Open = 1, Ended = 2 }
public enum EventKind : uint {  // other kinds exist, and later libraries may have more
  WorldOpened = 1,
  ConnectionLost = 2,
  ChunkChanged = 3,
  ChunkRemoved = 4,
  EditConfirmed = 6,
  EditRejected = 7,
  EditDurable = 8,
}

// All structs but Changes and WorldInfo have the same bytes in C# and in C, so that P/Invoke copies nothing.
[StructLayout(LayoutKind.Sequential)]
public struct Pos {
  public int X, Y, Z;
  public Pos(int x, int y, int z) { X = x; Y = y; Z = z; }
}
[StructLayout(LayoutKind.Sequential)]
public struct Box {
  public Pos Min, Max;  // half-open
}
[StructLayout(LayoutKind.Sequential)]
public struct Vec {
  public double X, Y, Z;
}
[StructLayout(LayoutKind.Sequential)]
public struct Place {
  public Vec At;
  public double YawDegrees, PitchDegrees;
}
[StructLayout(LayoutKind.Sequential)]
public struct Brush {
  public uint StructSize;
  public Mask Mask;
  public ushort MaskMaterial, Material;
}
[StructLayout(LayoutKind.Sequential)]
public struct Changes {
  public uint StructSize, IsChanged;
  public ulong Voxels;
  [MarshalAs(UnmanagedType.ByValArray, SizeConst = 48)]
  public byte[] Layers;  // 16 bytes for each axis
}
[StructLayout(LayoutKind.Sequential)]
public struct QuadFields {
  public uint StructSize, X, Y, Z, Width, Height, Direction, Material, Face;
}
[StructLayout(LayoutKind.Sequential)]
public struct Float2 {  // UnityEngine.Vector2 has the same bytes
  public float X, Y;
}
[StructLayout(LayoutKind.Sequential)]
public struct Float3 {  // UnityEngine.Vector3 has the same bytes
  public float X, Y, Z;
}
[StructLayout(LayoutKind.Sequential)]
public struct Vertex {
  public Float3 Position, Normal;
  public Float2 Uv;
  public ushort Material, Occlusion;
}
[StructLayout(LayoutKind.Sequential)]
public struct ClientOptions {
  public uint StructSize, Encryption;
  public IntPtr Server, Name, Invite, Password, KeyFile, KeySeed, AuthoritiesFile, CacheFolder;
  public uint ViewRadius, ViewRadiusVertical;
  public ulong MemoryMib, CacheMib;
  public IntPtr Wake, WakeContext;
}
[StructLayout(LayoutKind.Sequential)]
public struct Event {
  public uint StructSize;
  public EventKind Kind;
  public uint Flags, Detail;
  public Pos At;  // a chunk
  public uint Author;
  public ulong Edit, Sequence;
  public long UtcUs;
}
[StructLayout(LayoutKind.Sequential)]
public struct WorldInfo {
  public uint StructSize, ChunkEdge;
  public int YMin, YMax;
  public ulong EditVolumeMax;
  public Vec Spawn;
  [MarshalAs(UnmanagedType.ByValArray, SizeConst = 16)]
  public byte[] Id;
  public uint Author;
  [MarshalAs(UnmanagedType.ByValArray, SizeConst = 36)]
  public byte[] Name;  // UTF-8 with a zero at the end
  [MarshalAs(UnmanagedType.ByValArray, SizeConst = 136)]
  public byte[] Fingerprint;
  public string NameText { get { return Utf8.Read(Name); } }
}

// size_t is UIntPtr. A null array is NULL.
internal static class Native {
#if UNITY_5_3_OR_NEWER
  private const string Library = "runstone";  // Unity adds what the platform puts around the name
#else
  private const string Library = "librunstone.so.0";
#endif

  [DllImport(Library)] internal static extern uint runstone_abi();
  [DllImport(Library)] internal static extern IntPtr runstone_version();
  [DllImport(Library)] internal static extern IntPtr runstone_last_error();
  [DllImport(Library)] internal static extern IntPtr runstone_status_name(Status status);

  [DllImport(Library)]
  internal static extern Status runstone_chunk_create_filled(uint sideX, uint sideY, uint sideZ,
                                                             ushort material, out Chunk chunk);
  [DllImport(Library)]
  internal static extern Status runstone_chunk_create_from_array(uint sideX, uint sideY, uint sideZ,
                                                                 Order order, ushort[] voxels,
                                                                 UIntPtr count, out Chunk chunk);
  [DllImport(Library)] internal static extern Status runstone_chunk_free(IntPtr chunk);
  [DllImport(Library)]
  internal static extern Status runstone_chunk_get(Chunk chunk, uint x, uint y, uint z,
                                                   out ushort material);
  [DllImport(Library)]
  internal static extern Status runstone_chunk_apply(Chunk chunk, Pos at, Edits edits,
                                                     ref Changes changes);

  [DllImport(Library)] internal static extern Status runstone_edits_create(out Edits edits);
  [DllImport(Library)] internal static extern Status runstone_edits_free(IntPtr edits);
  [DllImport(Library)] internal static extern Status runstone_edits_clear(Edits edits);
  [DllImport(Library)]
  internal static extern Status runstone_edits_add_voxel(Edits edits, Pos at, ref Brush brush);
  [DllImport(Library)]
  internal static extern Status runstone_edits_add_box(Edits edits, Box box, ref Brush brush);
  [DllImport(Library)]
  internal static extern Status runstone_edits_add_sphere(Edits edits, Pos centre, uint radius,
                                                          ref Brush brush);

  [DllImport(Library)]
  internal static extern Status runstone_visibility_create(byte[] visibilities, UIntPtr count,
                                                           out Visibility visibility);
  [DllImport(Library)] internal static extern Status runstone_visibility_free(IntPtr visibility);
  [DllImport(Library)] internal static extern Status runstone_mesh_create(out Mesh mesh);
  [DllImport(Library)] internal static extern Status runstone_mesh_free(IntPtr mesh);
  [DllImport(Library)]
  internal static extern Status runstone_mesh_chunk(Mesh mesh, Chunk chunk, IntPtr[] neighbours,
                                                    IntPtr[] borders, Visibility visibility);
  [DllImport(Library)]
  internal static extern Status runstone_mesh_quads(Mesh mesh, Pass pass, ulong[] quads,
                                                    UIntPtr capacity, out UIntPtr count);
  [DllImport(Library)]
  internal static extern Status runstone_mesh_vertices(Mesh mesh, Pass pass, [Out] Vertex[] vertices,
                                                       UIntPtr capacity, out UIntPtr count);
  [DllImport(Library)]
  internal static extern Status runstone_mesh_indices(Mesh mesh, Pass pass, uint[] indices,
                                                      UIntPtr capacity, out UIntPtr count);
  [DllImport(Library)]
  internal static extern Status runstone_quad_unpack(ulong quad, ref QuadFields fields);

  [DllImport(Library)]
  internal static extern Status runstone_client_default_options(ref ClientOptions options);
  [DllImport(Library)]
  internal static extern Status runstone_client_connect(ref ClientOptions options, out Client client);
  [DllImport(Library)] internal static extern Status runstone_client_free(IntPtr client);
  [DllImport(Library)]
  internal static extern Status runstone_client_step(Client client, out uint hasMore);
  [DllImport(Library)]
  internal static extern Status runstone_client_wait(Client client, uint milliseconds);
  [DllImport(Library)]
  internal static extern Status runstone_client_drain(Client client, UIntPtr chunksMax,
                                                      [Out] Event[] events, UIntPtr eventSize,
                                                      UIntPtr capacity, out UIntPtr count);
  [DllImport(Library)]
  internal static extern Status runstone_client_event_text(Client client, UIntPtr index, byte[] text,
                                                           UIntPtr capacity, out UIntPtr count);
  [DllImport(Library)]
  internal static extern Status runstone_client_mesh(Client client, UIntPtr index, Mesh mesh);
  [DllImport(Library)]
  internal static extern Status runstone_client_state(Client client, out ClientState state,
                                                      out uint isComplete);
  [DllImport(Library)]
  internal static extern Status runstone_client_world(Client client, ref WorldInfo world);
  [DllImport(Library)]
  internal static extern Status runstone_client_place(Client client, out Place place);
  [DllImport(Library)]
  internal static extern Status runstone_client_move(Client client, ref Place place);
  [DllImport(Library)]
  internal static extern Status runstone_client_submit(Client client, Edits edits, UIntPtr index,
                                                       ulong action, out ulong number);
}

}  // namespace Runstone
