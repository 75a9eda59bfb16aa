// What was copied, and the address itself where the browser keeps it from the clipboard.
interface OfCopied {
  told: string;
  address: string;
  name: string;
}

export function Copied({ told, address, name }: OfCopied) {
  return (
    <>
      <p role="status" class="done">
        {told}
      </p>
      {address && (
        <input type="text" readOnly aria-label={name} value={address} ref={(field) => field?.select()} />
      )}
    </>
  );
}
