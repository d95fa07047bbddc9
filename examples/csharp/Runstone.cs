// Chunks, edits, meshes and a client of Runstone for C#. Each object is a SafeHandle: Dispose() frees
// what the library holds, and a call keeps its objects alive while it runs. A refusal of the library
// is a RunstoneException with its words. The rules of threads are those of runstone.h.
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Runstone {

public sealed class RunstoneException : Exception {
  public readonly Status Status;

  internal RunstoneException(Status status, string words) : base(words) { Status = status; }

  // Reads the words of the library in the thread that made the refused call.
  internal static void Check(Status status) {
    if (status == Status.Ok) return;
    string name = Utf8.Read(Native.runstone_status_name(status));
    throw new RunstoneException(status, name + ": " + Utf8.Read(Native.runstone_last_error()));
  }
}

internal static class Utf8 {
  internal static string Read(IntPtr text) {
    int length = 0;
    while (Marshal.ReadByte(text, length) != 0) ++length;
    var bytes = new byte[length];
    Marshal.Copy(text, bytes, 0, length);
    return Encoding.UTF8.GetString(bytes);
  }

  internal static string Read(byte[] text) {
    int length = Array.IndexOf(text, (byte)0);
    return Encoding.UTF8.GetString(text, 0, length < 0 ? text.Length : length);
  }

  // Copies a text with a zero at its end, or returns NULL for null. FreeHGlobal() frees it.
  internal static IntPtr Copy(string text) {
    if (text == null) return IntPtr.Zero;
    byte[] bytes = Encoding.UTF8.GetBytes(text + "\0");
    IntPtr copy = Marshal.AllocHGlobal(bytes.Length);
    Marshal.Copy(bytes, 0, copy, bytes.Length);
    return copy;
  }
}

public abstract class Handle : SafeHandle {
  protected Handle() : base(IntPtr.Zero, true) {}
  public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
}

// Voxels as runs.
public sealed class Chunk : Handle {
  private Chunk() {}
  protected override bool ReleaseHandle() { return Native.runstone_chunk_free(handle) == Status.Ok; }

  public static Chunk Filled(uint sideX, uint sideY, uint sideZ, ushort material) {
    Chunk chunk;
    RunstoneException.Check(
        Native.runstone_chunk_create_filled(sideX, sideY, sideZ, material, out chunk));
    return chunk;
  }

  // Makes a chunk of an array with a material for each voxel, flattened in `order`.
  public static Chunk FromArray(uint sideX, uint sideY, uint sideZ, Order order, ushort[] voxels) {
    Chunk chunk;
    RunstoneException.Check(Native.runstone_chunk_create_from_array(
        sideX, sideY, sideZ, order, voxels, (UIntPtr)voxels.Length, out chunk));
    return chunk;
  }

  public ushort this[uint x, uint y, uint z] {
    get {
      ushort material;
      RunstoneException.Check(Native.runstone_chunk_get(this, x, y, z, out material));
      return material;
    }
  }

  // Applies edits to the chunk at a place in the grid of chunks, and returns the changed voxels.
  public ulong Apply(Pos at, Edits edits) {
    var changes = new Changes { StructSize = (uint)Marshal.SizeOf(typeof(Changes)) };
    RunstoneException.Check(Native.runstone_chunk_apply(this, at, edits, ref changes));
    return changes.Voxels;
  }
}

// Edits, in the order in which they are applied.
public sealed class Edits : Handle {
  private Edits() {}
  protected override bool ReleaseHandle() { return Native.runstone_edits_free(handle) == Status.Ok; }

  public static Edits Create() {
    Edits edits;
    RunstoneException.Check(Native.runstone_edits_create(out edits));
    return edits;
  }

  public static Brush Brush(ushort material, Mask mask = Mask.Everything, ushort maskMaterial = 0) {
    return new Brush {
      StructSize = (uint)Marshal.SizeOf(typeof(Brush)),
      Mask = mask, MaskMaterial = maskMaterial, Material = material,
    };
  }

  public void Clear() { RunstoneException.Check(Native.runstone_edits_clear(this)); }
  public void AddVoxel(Pos at, Brush brush) {
    RunstoneException.Check(Native.runstone_edits_add_voxel(this, at, ref brush));
  }
  public void AddBox(Pos min, Pos max, Brush brush) {
    var box = new Box { Min = min, Max = max };
    RunstoneException.Check(Native.runstone_edits_add_box(this, box, ref brush));
  }
  public void AddSphere(Pos centre, uint radius, Brush brush) {
    RunstoneException.Check(Native.runstone_edits_add_sphere(this, centre, radius, ref brush));
  }
}

// How each material is drawn.
public sealed class Visibility : Handle {
  private Visibility() {}
  protected override bool ReleaseHandle() {
    return Native.runstone_visibility_free(handle) == Status.Ok;
  }

  // visibilities[i] is 0 (empty), 1 (opaque) or 2 (transparent) for material i; others are opaque.
  public static Visibility Create(params byte[] visibilities) {
    Visibility visibility;
    RunstoneException.Check(Native.runstone_visibility_create(
        visibilities, (UIntPtr)visibilities.Length, out visibility));
    return visibility;
  }
}

// Quads of a chunk.
public sealed class Mesh : Handle {
  private Mesh() {}
  protected override bool ReleaseHandle() { return Native.runstone_mesh_free(handle) == Status.Ok; }

  public static Mesh Create() {
    Mesh mesh;
    RunstoneException.Check(Native.runstone_mesh_create(out mesh));
    return mesh;
  }

  // Meshes a chunk. `neighbours` is null or six chunks by direction (-x, +x, -y, +y, -z, +z), of
  // which each may be null: its voxels then count as empty.
  public void Make(Chunk chunk, Chunk[] neighbours, Visibility visibility) {
    if (neighbours != null && neighbours.Length != 6)
      throw new ArgumentException("six neighbours are needed", "neighbours");
    // P/Invoke keeps no element of an array alive, so each is held here while the call runs.
    var held = new List<Chunk>();
    IntPtr[] pointers = neighbours == null ? null : new IntPtr[6];
    try {
      for (int i = 0; neighbours != null && i < 6; ++i) {
        if (neighbours[i] == null) continue;
        bool isHeld = false;
        neighbours[i].DangerousAddRef(ref isHeld);
        held.Add(neighbours[i]);
        pointers[i] = neighbours[i].DangerousGetHandle();
      }
      RunstoneException.Check(Native.runstone_mesh_chunk(this, chunk, pointers, null, visibility));
    } finally {
      foreach (Chunk each in held) each.DangerousRelease();
    }
  }

  // Returns the quads of cubes, 8 bytes each, for shaders that unpack them (runstone_quads.glsl).
  public ulong[] Quads(Pass pass) {
    UIntPtr count;
    RunstoneException.Check(Native.runstone_mesh_quads(this, pass, null, UIntPtr.Zero, out count));
    var quads = new ulong[(int)count];
    RunstoneException.Check(Native.runstone_mesh_quads(this, pass, quads, count, out count));
    return quads;
  }

  // Returns four vertices for each quad of cubes, for engines without a shader of their own.
  public Vertex[] Vertices(Pass pass) {
    UIntPtr count;
    RunstoneException.Check(Native.runstone_mesh_vertices(this, pass, null, UIntPtr.Zero, out count));
    var vertices = new Vertex[(int)count];
    RunstoneException.Check(Native.runstone_mesh_vertices(this, pass, vertices, count, out count));
    return vertices;
  }

  // Returns six indices for each quad of cubes: two triangles, counter-clockwise from outside.
  public uint[] Indices(Pass pass) {
    UIntPtr count;
    RunstoneException.Check(Native.runstone_mesh_indices(this, pass, null, UIntPtr.Zero, out count));
    var indices = new uint[(int)count];
    RunstoneException.Check(Native.runstone_mesh_indices(this, pass, indices, count, out count));
    return indices;
  }

  public static QuadFields Unpack(ulong quad) {
    var fields = new QuadFields { StructSize = (uint)Marshal.SizeOf(typeof(QuadFields)) };
    RunstoneException.Check(Native.runstone_quad_unpack(quad, ref fields));
    return fields;
  }
}

// A player in the world of a server. One thread at a time calls it.
public sealed class Client : Handle {
  private readonly Event[] events_ = new Event[256];

  private Client() {}
  protected override bool ReleaseHandle() { return Native.runstone_client_free(handle) == Status.Ok; }

  // Starts to connect and returns at once. `server` is HOST, HOST:PORT or a link runstone://.
  // Without a file for its key the player is a new one in each run.
  public static Client Connect(string server, string name = null, string keyFile = null,
                               uint viewRadius = 8, uint viewRadiusVertical = 4) {
    var options = new ClientOptions { StructSize = (uint)Marshal.SizeOf(typeof(ClientOptions)) };
    RunstoneException.Check(Native.runstone_client_default_options(ref options));
    options.ViewRadius = viewRadius;
    options.ViewRadiusVertical = viewRadiusVertical;
    try {
      options.Server = Utf8.Copy(server);
      options.Name = Utf8.Copy(name);
      options.KeyFile = Utf8.Copy(keyFile);
      Client client;
      RunstoneException.Check(Native.runstone_client_connect(ref options, out client));
      return client;
    } finally {  // the library has copied the texts
      Marshal.FreeHGlobal(options.Server);
      Marshal.FreeHGlobal(options.Name);
      Marshal.FreeHGlobal(options.KeyFile);
    }
  }

  // Handles received messages and sends due ones. Call it every frame. Returns true if messages are
  // left for the next call.
  public bool Step() {
    uint hasMore;
    RunstoneException.Check(Native.runstone_client_step(this, out hasMore));
    return hasMore != 0;
  }

  // Waits until Step() has something to do. A program with frames does not need it.
  public void Wait(uint milliseconds) {
    RunstoneException.Check(Native.runstone_client_wait(this, milliseconds));
  }

  // Returns the next events, with at most `chunksMax` changed chunks. Their places in the result name
  // them for Mesh() and Text() until the next call. The array is used again by the next call.
  public ArraySegment<Event> Drain(int chunksMax) {
    UIntPtr count;
    RunstoneException.Check(Native.runstone_client_drain(
        this, (UIntPtr)chunksMax, events_, (UIntPtr)Marshal.SizeOf(typeof(Event)),
        (UIntPtr)events_.Length, out count));
    return new ArraySegment<Event>(events_, 0, (int)count);
  }

  // Meshes the chunk of a drained ChunkChanged with the materials and neighbours of the world.
  public void MakeMesh(int index, Mesh mesh) {
    RunstoneException.Check(Native.runstone_client_mesh(this, (UIntPtr)index, mesh));
  }

  // Returns the text of a drained event: a line of the chat, or why something failed.
  public string Text(int index) {
    UIntPtr count;
    RunstoneException.Check(
        Native.runstone_client_event_text(this, (UIntPtr)index, null, UIntPtr.Zero, out count));
    var text = new byte[(int)count];
    RunstoneException.Check(
        Native.runstone_client_event_text(this, (UIntPtr)index, text, count, out count));
    return Utf8.Read(text);
  }

  public ClientState State {
    get {
      ClientState state;
      uint isComplete;
      RunstoneException.Check(Native.runstone_client_state(this, out state, out isComplete));
      return state;
    }
  }

  // True if all chunks around the player have arrived.
  public bool IsComplete {
    get {
      ClientState state;
      uint isComplete;
      RunstoneException.Check(Native.runstone_client_state(this, out state, out isComplete));
      return isComplete != 0;
    }
  }

  public WorldInfo World {
    get {
      var world = new WorldInfo { StructSize = (uint)Marshal.SizeOf(typeof(WorldInfo)) };
      RunstoneException.Check(Native.runstone_client_world(this, ref world));
      return world;
    }
  }

  // The place of the player. Setting it moves the player, and the chunks around.
  public Place Place {
    get {
      Place place;
      RunstoneException.Check(Native.runstone_client_place(this, out place));
      return place;
    }
    set { RunstoneException.Check(Native.runstone_client_move(this, ref value)); }
  }

  // Shows an edit of a list at once, sends it and returns its number. An event reports its outcome.
  public ulong Submit(Edits edits, int index) {
    ulong number;
    RunstoneException.Check(
        Native.runstone_client_submit(this, edits, (UIntPtr)index, 0, out number));
    return number;
  }
}

public static class Library {
  public static string Version { get { return Utf8.Read(Native.runstone_version()); } }
  public static uint Abi { get { return Native.runstone_abi(); } }
}

}  // namespace Runstone
