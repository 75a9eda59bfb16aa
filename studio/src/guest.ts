// The read-only link by which this page was opened: #g=TOKEN&s=KEY. The service refuses all but reading its session;
// the page leaves out what would be refused.

const told = new URLSearchParams(location.hash.slice(1));

/** The token of the link; "" in a browser that logs in. */
export const guest = told.get("g") ?? "";

/** The headers of a request of this page, which has no cookie of its own then. */
export const signed = (headers: HeadersInit | undefined): HeadersInit =>
  guest ? { ...(headers as Record<string, string>), authorization: `Bearer ${guest}` } : (headers ?? {});

/** The subprotocols of a socket of this page. */
export const spoken = () => (guest ? ["hookean", `bearer.${guest}`] : []);

export const READ_ONLY = "This link only reads the session; ask the person who shared it to change something.";
