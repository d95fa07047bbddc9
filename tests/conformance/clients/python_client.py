"""The client of the Python package under test by runstone-conformance.

python_client.py ADDRESS KEY tls|plain
"""
import asyncio
import sys

import runstone


def say(*words):
    print(*words, flush=True)


async def report(client):
    async for event in client:
        if event.kind == "opened":
            say("open")
        elif event.kind == "lost":
            say("lost", "final" if event.is_final else "again", event.text)
        elif event.kind == "edit confirmed":
            say("applied", event.sequence)
        elif event.kind == "edit rejected":
            say("rejected", event.name or event.text)


def print_digests(client):
    # A client that the server has refused shows nothing.
    for at in [] if client.closed else client.chunks():
        digest = client.chunk(at).digest
        say("chunk", *at, digest[:16], digest[16:])
    say("done")


def obey(client, verb, words):
    if verb == "digest":
        print_digests(client)
    elif verb == "edit":
        try:
            client.submit(runstone.Edit.decode(bytes.fromhex(words[0])))
        except runstone.Error as error:
            say("rejected", error)
    elif verb == "move":
        client.move(*(float(word) for word in words))


async def main(address, key, encryption):
    loop = asyncio.get_running_loop()
    lines = asyncio.StreamReader()
    await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(lines), sys.stdin)
    client = runstone.Client(address, encryption="none" if encryption == "plain" else "any certificate",
                             view_radius=2, view_radius_vertical=2)
    joining = loop.create_task(client.join())
    await asyncio.sleep(0)
    events = loop.create_task(report(client))
    while line := (await lines.readline()).decode().split():
        if line[0] == "quit":
            break
        obey(client, line[0], line[1:])
    for task in joining, events:
        task.cancel()
    await asyncio.gather(joining, events, return_exceptions=True)
    await client.close()


asyncio.run(main(*sys.argv[1:]))
